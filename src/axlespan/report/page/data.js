const content = JSON.parse(document.getElementById("content").textContent);
const WIDTHS = { f4: 4, f8: 8, i2: 2, i4: 4 };
const KINDS = { f4: Float32Array, f8: Float64Array, i2: Int16Array, i4: Int32Array };

const arrays = (() => {
  const total = content.arrays.reduce((sum, [kind, n]) => sum + WIDTHS[kind] * n, 0);
  const text = atob(document.getElementById("data").textContent.trim());
  const packed = new Uint8Array(text.length);
  for (let i = 0; i < text.length; i++) packed[i] = text.charCodeAt(i);
  const bytes = total ? inflate(packed, total) : new Uint8Array(0);
  const found = [];
  let begin = 0;
  for (const [kind, n] of content.arrays) {
    found.push({ kind, n, begin, values: null });
    begin += WIDTHS[kind] * n;
  }
  return i => {
    const item = found[i];
    if (!item.values) {
      const width = WIDTHS[item.kind], raw = new Uint8Array(width * item.n);
      for (let b = 0; b < width; b++)
        for (let k = 0, from = item.begin + b * item.n; k < item.n; k++) raw[k * width + b] = bytes[from + k];
      item.values = new KINDS[item.kind](raw.buffer);
    }
    return item.values;
  };
})();

// Whole numbers back to what they stand for; -32768 is a gap.
function restored(q) {
  if (!q) return null;
  if (!q.values) {
    const whole = arrays(q.a), values = new Float32Array(whole.length);
    for (let i = 0; i < whole.length; i++) values[i] = whole[i] === -32768 ? NaN : q.offset + q.scale * whole[i];
    q.values = values;
  }
  return q.values;
}

const byId = id => document.getElementById(id);
function el(tag, attributes = {}, ...children) {
  const node = document.createElement(tag);
  for (const [key, value] of Object.entries(attributes)) {
    if (key.startsWith("on")) node.addEventListener(key.slice(2), value);
    else if (value === true) node.setAttribute(key, "");
    else if (value !== false && value != null) node.setAttribute(key, value);
  }
  node.append(...children);
  return node;
}
function shown(value, digits = 4) {
  if (value == null || !Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  const text = size >= 1e7 || size < 1e-4 ? value.toExponential(2) : value.toFixed(Math.max(0, Math.min(12, digits - 1 - Math.floor(Math.log10(size)))));
  return text.replace("-", "−");
}
const css = name => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
const curveColor = i => css(`--c${1 + i % 6}`);
const DASHES = [[], [7, 4], [2, 3], [9, 3, 2, 3]];
const curveDash = i => DASHES[Math.floor(i / 6) % DASHES.length];
const say = text => { byId("said").textContent = text; };

// Who draws with colors redraws when they change.
const repaints = [];
function repaint() { for (const paint of repaints) paint(); }

// A time that all views point at, and the time of the animation.
function bus() {
  const heard = [];
  return { on: f => heard.push(f), tell: (value, from) => { for (const f of heard) f(value, from); } };
}
const pointed = bus(), zoomed = bus(), played = bus();

// Last index with x[i] <= value, in increasing x.
function below(x, value) {
  let a = 0, b = x.length - 1;
  if (!(value > x[0])) return 0;
  while (b - a > 1) { const m = (a + b) >> 1; if (x[m] <= value) a = m; else b = m; }
  return x[b] <= value ? b : a;
}
