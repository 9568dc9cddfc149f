function download(text, name, type) {
  const link = el("a", { href: URL.createObjectURL(new Blob([text], { type })), download: name });
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(link.href), 5000);
}
const fileName = (key, end) => `${content.title.toLowerCase().replace(/[^a-z0-9.]+/g, "-").replace(/^-|-$/g, "").slice(0, 60)}-${key}.${end}`;
const quoted = text => /[",\n]/.test(text) ? `"${text.replace(/"/g, '""')}"` : text;

// Columns {name, values}; gaps stay empty.
function csv(columns) {
  const lines = [columns.map(c => quoted(c.name)).join(",")];
  const n = Math.max(...columns.map(c => c.values.length));
  for (let i = 0; i < n; i++)
    lines.push(columns.map(c => { const v = c.values[i]; return v == null || Number.isNaN(v) ? "" : c.single ? Number(v.toPrecision(7)) : Number(v.toPrecision(14)); }).join(","));
  return lines.join("\r\n") + "\r\n";
}

const escaped = text => String(text).replace(/[&<>"]/g, c => ({ "&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;" })[c]);

function ticks(low, high, count) {
  if (!(high > low)) return [low];
  const rough = (high - low) / count, power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map(m => m * power).find(s => s >= rough * 0.999), found = [];
  for (let v = Math.ceil(low / step - 1e-9) * step; v <= high + 1e-9 * step; v += step) found.push(Math.abs(v) < 1e-12 * step ? 0 : v);
  return found;
}
// Decimals that a step of ticks needs: 2.5 needs one.
const decimals = step => { let d = 0; while (d < 9 && Math.abs(step * 10 ** d - Math.round(step * 10 ** d)) > 1e-4 * step * 10 ** d) d++; return d; };
const tickText = (v, all) => {
  const step = all.length > 1 ? Math.abs(all[1] - all[0]) : Math.abs(v) || 1;
  if (Math.abs(v) >= 1e6 || (v !== 0 && step < 1e-5)) return v.toExponential(1).replace(/-/g, "−");
  return v.toFixed(decimals(step)).replace("-", "−");
};

// A plot as SVG: curves {name, color, dash, x, y}, inside ranges, with axes and a legend.
function plotSvg({ title, xLabel, yLabel, xRange, yRange, curves, under = "" }) {
  const W = 900, H = 420, L = 78, R = 18, T = 44 + 18 * Math.ceil(curves.length / 5), B = 52;
  const px = v => L + (v - xRange[0]) / (xRange[1] - xRange[0]) * (W - L - R);
  const py = v => H - B - (v - yRange[0]) / (yRange[1] - yRange[0]) * (H - T - B);
  const parts = [`<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" viewBox="0 0 ${W} ${H}" width="${W}" height="${H}" font-family="Helvetica, Arial, sans-serif" font-size="13">`,
    `<rect width="${W}" height="${H}" fill="#fff"/><text x="${L}" y="22" font-size="15" font-weight="bold">${escaped(title)}</text>`,
    `<clipPath id="inside"><rect x="${L}" y="${T}" width="${W - L - R}" height="${H - T - B}"/></clipPath>`, under && under({ L, R, T, B, W, H })];
  const xs = ticks(...xRange, 8), ys = ticks(...yRange, 6);
  for (const v of xs) parts.push(`<path d="M${px(v).toFixed(1)} ${T}V${H - B}" stroke="#ddd" fill="none"/><text x="${px(v).toFixed(1)}" y="${H - B + 18}" text-anchor="middle">${tickText(v, xs)}</text>`);
  for (const v of ys) parts.push(`<path d="M${L} ${py(v).toFixed(1)}H${W - R}" stroke="#ddd" fill="none"/><text x="${L - 8}" y="${(py(v) + 4).toFixed(1)}" text-anchor="end">${tickText(v, ys)}</text>`);
  parts.push(`<g clip-path="url(#inside)" fill="none" stroke-width="1.5">`);
  for (const c of curves) {
    let d = "", pen = "M";
    for (let i = 0; i < c.x.length; i++) {
      const y = c.y[i];
      if (y === undefined) continue;
      if (y === null || Number.isNaN(y)) { pen = "M"; continue; }
      if (c.x[i + 1] < xRange[0] || c.x[i - 1] > xRange[1]) continue;
      d += `${pen}${px(c.x[i]).toFixed(1)} ${py(y).toFixed(1)}`;
      pen = "L";
    }
    parts.push(`<path d="${d}" stroke="${c.color}"${c.dash && c.dash.length ? ` stroke-dasharray="${c.dash.join(" ")}"` : ""}/>`);
  }
  parts.push(`</g><rect x="${L}" y="${T}" width="${W - L - R}" height="${H - T - B}" fill="none" stroke="#444"/>`);
  curves.forEach((c, i) => {
    const x = L + (i % 5) * 160, y = 42 + 18 * Math.floor(i / 5);
    parts.push(`<path d="M${x} ${y - 4}h22" stroke="${c.color}" stroke-width="2.5"${c.dash && c.dash.length ? ` stroke-dasharray="${c.dash.join(" ")}"` : ""}/><text x="${x + 28}" y="${y}">${escaped(c.name)}</text>`);
  });
  parts.push(`<text x="${(L + W - R) / 2}" y="${H - 12}" text-anchor="middle">${escaped(xLabel)}</text>`,
    `<text transform="translate(18 ${(T + H - B) / 2}) rotate(-90)" text-anchor="middle">${escaped(yLabel)}</text></svg>`);
  return parts.join("\n");
}
