// The crossing in space: the surface of shells and solids, colored, with the train on it.
class SpaceView {
  constructor(scene, spec, stage, state) {
    Object.assign(this, { scene, spec, stage, state });
    this.canvas = el("canvas", { "aria-hidden": "true" });
    this.renderer = new THREE.WebGLRenderer({ canvas: this.canvas, antialias: true, preserveDrawingBuffer: true });
    stage.append(this.canvas);
    this.points = arrays(spec.points); this.faces = arrays(spec.faces);
    this.world = new THREE.Scene();
    this.world.add(new THREE.AmbientLight(0xffffff, 1.6));
    const sun = new THREE.DirectionalLight(0xffffff, 1.8);
    sun.position.set(-0.4, -1, 1.6);
    this.world.add(sun);
    this.surface(); this.rails(); this.vehicles();
    const box = new THREE.Box3().setFromObject(this.mesh), size = box.getSize(new THREE.Vector3()), middle = box.getCenter(new THREE.Vector3());
    this.size = size.length();
    this.camera = new THREE.PerspectiveCamera(35, 2, 0.01 * this.size, 20 * this.size);
    this.camera.up.set(0, 0, 1);
    this.camera.position.copy(middle).add(new THREE.Vector3(-0.35, -1, 0.5).multiplyScalar(0.88 * this.size + 3));
    this.controls = new THREE.OrbitControls(this.camera, this.canvas);
    this.controls.target.copy(middle);
    this.controls.update();
    this.controls.addEventListener("change", () => this.render());
    this.fit();
  }

  surface() {
    const n = this.faces.length, geometry = new THREE.BufferGeometry();
    this.places = new THREE.BufferAttribute(new Float32Array(3 * n), 3);
    this.colors = new THREE.BufferAttribute(new Float32Array(3 * n), 3);
    for (let i = 0; i < n; i++) for (let k = 0; k < 3; k++) this.places.array[3 * i + k] = this.points[3 * this.faces[i] + k];
    geometry.setAttribute("position", this.places);
    geometry.setAttribute("color", this.colors);
    this.mesh = new THREE.Mesh(geometry, new THREE.MeshLambertMaterial({ vertexColors: true, side: THREE.DoubleSide, flatShading: true }));
    this.mesh.frustumCulled = false;
    this.world.add(this.mesh);
    this.outline = new THREE.LineSegments(new THREE.EdgesGeometry(geometry, 30), new THREE.LineBasicMaterial({ color: 0x808890 }));
    this.world.add(this.outline);
    this.moved = new Float32Array(this.points.length);
    this.stations = Float64Array.from({ length: this.points.length / 3 }, (_, i) => this.station(this.points[3 * i], this.points[3 * i + 1]));
  }

  // Position along the main line of the point of it that is nearest in plan.
  station(x, y) {
    const rows = this.spec.lines[this.spec.main];
    let best = Infinity, s = 0;
    for (let i = 0; i + 1 < rows.length; i++) {
      const [s0, x0, y0] = rows[i], [s1, x1, y1] = rows[i + 1], dx = x1 - x0, dy = y1 - y0;
      const f = Math.min(Math.max(((x - x0) * dx + (y - y0) * dy) / (dx * dx + dy * dy || 1), 0), 1);
      const d = (x - x0 - f * dx) ** 2 + (y - y0 - f * dy) ** 2;
      if (d < best) { best = d; s = s0 + f * (s1 - s0); }
    }
    return s;
  }

  // A point of a line, on its straight continuation beyond the ends, and its direction in plan.
  at(line, s) {
    const rows = this.spec.lines[line] || this.spec.lines[this.spec.main];
    let i = 0;
    while (i + 2 < rows.length && rows[i + 1][0] < s) i++;
    const p = rows[i], q = rows[i + 1], f = (s - p[0]) / (q[0] - p[0]);
    return { x: p[1] + f * (q[1] - p[1]), y: p[2] + f * (q[2] - p[2]), z: p[3] + f * (q[3] - p[3]), turn: Math.atan2(q[2] - p[2], q[1] - p[1]) };
  }

  rails() {
    const [a, b] = this.scene.ends, reach = 0.35 * (b - a), points = [];
    for (const name of Object.keys(this.spec.lines)) for (const [p, q] of [[a - reach, a], [b, b + reach]]) {
      const u = this.at(name, p), v = this.at(name, q);
      points.push(u.x, u.y, u.z, v.x, v.y, v.z);
    }
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(points), 3));
    this.world.add(new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({ color: 0x7a5230 })));
  }

  vehicles() {
    const wheel = new THREE.CylinderGeometry(0.46, 0.46, 0.14, 24);
    this.units = this.scene.units.map(unit => ({
      unit,
      boxes: unit.boxes.map(([, , length, bottom, top, low]) => {
        const mesh = new THREE.Mesh(new THREE.BoxGeometry(length, Math.min(low ? 2 : 2.7, this.width()), top - bottom), new THREE.MeshLambertMaterial({ color: low ? 0x56636f : 0x3f6fa3, transparent: !low, opacity: low ? 1 : 0.5 }));
        this.world.add(mesh);
        return mesh;
      }),
      wheels: unit.wheels.map(() => { const mesh = new THREE.Mesh(wheel, new THREE.MeshLambertMaterial()); this.world.add(mesh); return mesh; }),
    }));
  }

  width() {
    let low = Infinity, high = -Infinity;
    for (let i = 1; i < this.points.length; i += 3) { low = Math.min(low, this.points[i]); high = Math.max(high, this.points[i]); }
    return Math.max(0.4, 0.8 * (high - low)) || 2.7;
  }

  colorings() {
    const found = [["size", "size of displacement"], ["down", "vertical displacement"]];
    if (this.spec.stress) found.unshift(["stress", "von Mises stress"]);
    return found;
  }

  words() {
    return this.spec.motion ? "The surface moves as computed (whole fields, linear between their times)."
      : "Whole fields were not kept (output: fields: {every: n}), so the surface follows the deflection of the line across its width.";
  }

  // Displacements of all points now, in metres, not enlarged.
  displace() {
    const { motion } = this.spec, u = this.moved;
    if (!motion) {
      for (let i = 0; i < this.stations.length; i++) { u[3 * i] = u[3 * i + 1] = 0; u[3 * i + 2] = this.scene.w(this.stations[i]); }
      return { row: 0, part: 0 };
    }
    const times = arrays(motion.t), table = restored(motion.u), n = u.length;
    const row = Math.min(below(times, this.scene.now), times.length - 2);
    const part = Math.min(Math.max((this.scene.now - times[row]) / (times[row + 1] - times[row]), 0), 1);
    for (let i = 0; i < n; i++) u[i] = (1 - part) * table[row * n + i] + part * table[(row + 1) * n + i];
    return { row, part };
  }

  draw() {
    const { scene, state, faces, points } = this, f = state.factor, when = this.displace(), u = this.moved;
    const most = state.color === "stress" ? this.spec.stress.most : (this.spec.motion ? this.spec.motion.most : scene.line ? scene.line.most : 1) || 1;
    const place = this.places.array, color = this.colors.array, count = faces.length / 3;
    const stress = state.color === "stress" ? restored(this.spec.stress) : null;
    for (let i = 0; i < faces.length; i++) {
      const p = 3 * faces[i];
      for (let k = 0; k < 3; k++) place[3 * i + k] = points[p + k] + f * u[p + k];
      let share;
      if (stress) { const t = Math.floor(i / 3); share = ((1 - when.part) * stress[when.row * count + t] + when.part * stress[(when.row + 1) * count + t]) / most; }
      else share = state.color === "down" ? 0.5 - 0.5 * u[p + 2] / most : Math.hypot(u[p], u[p + 1], u[p + 2]) / most;
      const c = mixed(SEQUENTIAL, share);
      color[3 * i] = (c[0] / 255) ** 2.2; color[3 * i + 1] = (c[1] / 255) ** 2.2; color[3 * i + 2] = (c[2] / 255) ** 2.2;
    }
    this.places.needsUpdate = true; this.colors.needsUpdate = true;
    if (this.legend) {
      if (stress) this.legend.set("von Mises stress", "0", `${shown(most)} MPa`);
      else if (state.color === "down") this.legend.set("vertical displacement", `${shown(1e3 * most)} mm up`, `${shown(1e3 * most)} mm down`);
      else this.legend.set("displacement", "0", `${shown(1e3 * most)} mm`);
    }
    for (const { unit, boxes, wheels } of this.units) {
      unit.boxes.forEach(([name, center, , bottom, top], i) => {
        const p = this.at(this.spec.main, scene.place(unit, center));
        boxes[i].position.set(p.x, p.y + this.offset(unit), p.z + f * (scene.dof(`${name}.z`) ?? 0) + 0.5 * (bottom + top));
        boxes[i].rotation.set(0, scene.trains[unit.train].way * Math.atan(f * scene.tilt(name)), p.turn, "ZYX");
      });
      unit.wheels.forEach((w, i) => {
        const p = this.at(w[3], scene.place(unit, w[1]));
        wheels[i].position.set(p.x, p.y, p.z + f * scene.wheel(w, unit) + 0.46);
        wheels[i].rotation.set(0, 0, p.turn);
        wheels[i].material.color.set(loadColor(scene.ratio(w[0])));
      });
    }
    this.render();
  }

  // Bodies stand over the middle of their wheels.
  offset(unit) {
    const main = this.at(this.spec.main, 0).y, ys = unit.wheels.map(w => this.at(w[3], 0).y);
    return ys.reduce((sum, y) => sum + y, 0) / ys.length - main;
  }

  render() {
    this.world.background = new THREE.Color(css("--panel"));
    this.renderer.render(this.world, this.camera);
  }

  fit() {
    const W = Math.max(this.stage.clientWidth, 200), H = W < 560 ? 260 : 420;
    this.renderer.setPixelRatio(Math.min(devicePixelRatio || 1, 2));
    this.renderer.setSize(W, H, false);
    this.canvas.style.height = `${H}px`;
    this.camera.aspect = W / H;
    this.camera.updateProjectionMatrix();
  }

  key(key) {
    const turn = { a: [-0.1, 0], d: [0.1, 0], w: [0, -0.1], s: [0, 0.1] }[key.toLowerCase()];
    const arm = this.camera.position.clone().sub(this.controls.target);
    if (turn) {
      const r = arm.length(), flat = Math.atan2(arm.y, arm.x) + turn[0], up = Math.min(Math.max(Math.acos(arm.z / r) + turn[1], 0.05), 3.09);
      arm.set(r * Math.sin(up) * Math.cos(flat), r * Math.sin(up) * Math.sin(flat), r * Math.cos(up));
    } else if (key === "+" || key === "=") arm.multiplyScalar(0.85);
    else if (key === "-") arm.multiplyScalar(1 / 0.85);
    else return false;
    this.camera.position.copy(this.controls.target).add(arm);
    this.controls.update();
    this.render();
    return true;
  }
}
