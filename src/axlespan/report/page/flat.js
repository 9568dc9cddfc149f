// The crossing from the side, to scale but for the deflections.
class FlatView {
  constructor(scene, stage, state) {
    Object.assign(this, { scene, stage, state });
    this.canvas = el("canvas", { "aria-hidden": "true" });
    stage.append(this.canvas);
    this.fit();
  }

  fit() {
    const px = devicePixelRatio || 1, W = Math.max(this.stage.clientWidth, 200), H = (W < 560 ? 210 : 290) + (this.scene.legs.length ? 70 : 0);
    this.W = W; this.H = H;
    this.canvas.width = Math.round(W * px); this.canvas.height = Math.round(H * px);
    this.canvas.style.height = `${H}px`;
  }

  // Positions at the left and right edge.
  window_() {
    const { scene, state } = this, [a, b] = scene.ends, L = b - a, head = scene.head();
    const train = Math.max(...scene.units.filter(u => u.train === 0).map(u => u.rear)), way = scene.trains[0].way;
    if (state.view === "follow") { const half = Math.min(0.75 * L, Math.max(20, 0.3 * L)); return [head - (1 + 0.2 * way) * half, head + (1 - 0.2 * way) * half]; }
    if (state.view === "train") { const half = 0.55 * Math.max(train, 0.4 * L); const middle = head - 0.5 * way * train; return [middle - half, middle + half]; }
    return [a - 0.2 * L, b + 0.2 * L];
  }

  draw() {
    const { scene, state, W, H } = this, ctx = this.canvas.getContext("2d"), px = devicePixelRatio || 1;
    ctx.setTransform(px, 0, 0, px, 0, 0);
    ctx.clearRect(0, 0, W, H);
    const [left, right] = this.window_(), scale = W / (right - left), base = (scene.legs.length ? 0.38 : 0.6) * H, f = state.factor;
    const X = s => (s - left) * scale, Y = z => base - z * scale, [a, b] = scene.ends, L = b - a;
    const depth = Math.min(Math.max(0.05 * L, 0.3), 2.2), color = name => css(name);
    ctx.lineJoin = "round";
    // ground
    ctx.fillStyle = color("--earth");
    const drop = Math.max(0.6 * scale, 8);
    if (a > left) ctx.fillRect(0, base, X(a), drop);
    if (b < right) ctx.fillRect(X(b), base, W - X(b), drop);
    // piers and legs: their heads go with the deck
    ctx.strokeStyle = color("--deck"); ctx.lineWidth = Math.min(12, Math.max(4, 0.5 * scale));
    for (const [x0, z0, x1, z1] of scene.legs) {
      const end = (x, z) => [X(x), Y(z + (z > -0.05 ? f * scene.w(x) : 0))];
      ctx.beginPath(); ctx.moveTo(...end(x0, z0)); ctx.lineTo(...end(x1, z1)); ctx.stroke();
    }
    // structure: where it was, and where it is
    const begin = Math.max(a, left), end = Math.min(b, right), n = Math.max(2, Math.min(240, Math.round((end - begin) * scale / 4)));
    ctx.strokeStyle = color("--soft"); ctx.lineWidth = 1; ctx.setLineDash([4, 4]);
    ctx.beginPath(); ctx.moveTo(X(begin), base); ctx.lineTo(X(end), base); ctx.stroke(); ctx.setLineDash([]);
    if (end > begin) {
      const top = Array.from({ length: n + 1 }, (_, i) => { const s = begin + (end - begin) * i / n; return [X(s), Y(f * scene.w(s))]; });
      const thick = depth * scale;
      ctx.beginPath();
      top.forEach(([x, y], i) => i ? ctx.lineTo(x, y) : ctx.moveTo(x, y));
      for (let i = n; i >= 0; i--) ctx.lineTo(top[i][0], top[i][1] + thick);
      ctx.closePath(); ctx.fillStyle = color("--deck"); ctx.fill(); ctx.strokeStyle = color("--deck-line"); ctx.lineWidth = 1.2; ctx.stroke();
    }
    // running surface, with its unevenness
    ctx.strokeStyle = color("--rail"); ctx.lineWidth = 2.4; ctx.beginPath();
    for (let x = 0; x <= W; x += 2) { const s = left + x / scale; ctx.lineTo(x, Y(f * (scene.w(s) + scene.r(s)))); }
    ctx.stroke();
    // supports
    const size = Math.min(Math.max(0.9 * scale, 8), 15);
    ctx.fillStyle = color("--deck-line");
    for (const p of scene.supports) {
      const x = X(p.x), y = p.below > depth ? Y(-p.below) : Y(f * scene.w(p.x)) + depth * scale;
      ctx.beginPath(); ctx.moveTo(x, y); ctx.lineTo(x - 0.6 * size, y + size); ctx.lineTo(x + 0.6 * size, y + size); ctx.closePath(); ctx.fill();
      if (!p.fixed) ctx.fillRect(x - 0.8 * size, y + 1.2 * size, 1.6 * size, 1.6);
    }
    this.train(ctx, X, Y, scale, f, left, right);
    ctx.fillStyle = color("--soft"); ctx.font = "12px system-ui, sans-serif"; ctx.textAlign = "left";
    const bar = nice(0.15 * (right - left));
    ctx.fillRect(10, H - 14, bar * scale, 2); ctx.fillText(`${bar} m; deflections × ${f}`, 16 + bar * scale, H - 9);
  }

  train(ctx, X, Y, scale, f, left, right) {
    const { scene } = this;
    for (const unit of scene.units) {
      const ends = [scene.place(unit, unit.front), scene.place(unit, unit.rear)], way = scene.trains[unit.train].way;
      if (Math.max(...ends) < left || Math.min(...ends) > right) continue;
      const at = unit.wheels.map(w => [X(scene.place(unit, w[1])), f * scene.wheel(w, unit)]);
      const lowest = unit.boxes.length ? Math.min(...unit.boxes.map(b => b[3])) : 0;
      const boxes = unit.boxes.map(([name, center, length, bottom, top, low]) => ({ name, low, way, x: X(scene.place(unit, center)), z: f * (scene.dof(`${name}.z`) ?? 0), turn: f * scene.tilt(name), length, bottom, top, center }));
      for (const b of boxes) if (!b.low) this.body(ctx, b, Y, scale);
      // suspensions: from a wheel to what stands over it
      ctx.strokeStyle = css("--soft"); ctx.lineWidth = 1.6;
      unit.wheels.forEach((w, i) => {
        const over = boxes.filter(b => Math.abs(b.center - w[1]) <= 0.5 * b.length + 0.3).sort((p, q) => p.bottom - q.bottom)[0];
        if (!over) return;
        const arm = w[1] - over.center;
        ctx.beginPath(); ctx.moveTo(at[i][0], Y(at[i][1] + 0.46)); ctx.lineTo(at[i][0], Y(over.z + arm * over.turn + over.bottom)); ctx.stroke();
      });
      for (const b of boxes) if (b.low) {
        const above = boxes.find(c => !c.low && Math.abs(c.center - b.center) <= 0.5 * c.length);
        if (above) { const arm = b.center - above.center; ctx.beginPath(); ctx.moveTo(b.x, Y(b.z + b.top)); ctx.lineTo(b.x, Y(above.z + arm * above.turn + above.bottom)); ctx.stroke(); }
      }
      for (const b of boxes) if (b.low) this.body(ctx, b, Y, scale);
      at.forEach(([x, z], i) => {
        const radius = Math.max(0.46 * scale, 3), y = Y(z + 0.46) + (radius > 0.46 * scale ? 0.46 * scale - radius : 0);
        ctx.fillStyle = loadColor(scene.ratio(unit.wheels[i][0])); ctx.strokeStyle = css("--wheel"); ctx.lineWidth = 1.3;
        if (!unit.boxes.length) { // a moving force
          const tip = Y(z) - 2; ctx.strokeStyle = css("--c2"); ctx.lineWidth = 2.2;
          ctx.beginPath(); ctx.moveTo(x, tip - 36); ctx.lineTo(x, tip); ctx.moveTo(x - 4, tip - 8); ctx.lineTo(x, tip); ctx.lineTo(x + 4, tip - 8); ctx.stroke();
          return;
        }
        ctx.beginPath(); ctx.arc(x, y, radius, 0, 2 * Math.PI); ctx.fill(); ctx.stroke();
      });
    }
  }

  // A box turned about its center; positive pitch lowers the front, which is to the right.
  body(ctx, b, Y, scale) {
    const half = 0.5 * b.length * scale, height = (b.top - b.bottom) * scale, y = Y(b.z + 0.5 * (b.top + b.bottom));
    ctx.save();
    ctx.translate(b.x, y);
    ctx.rotate(b.way * Math.atan(b.turn));
    ctx.fillStyle = css(b.low ? "--bogie" : "--body"); ctx.strokeStyle = css(b.low ? "--wheel" : "--body-2"); ctx.lineWidth = 1.4;
    const r = Math.min(0.14 * height, 8);
    ctx.beginPath(); ctx.roundRect(-half, -height / 2, 2 * half, height, r); ctx.fill(); ctx.stroke();
    ctx.restore();
  }
}
