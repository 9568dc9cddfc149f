// Unpacks a zlib stream (RFC 1950, 1951): everywhere, at once, without asking what the browser offers.
const LENGTH_BASE = [3,4,5,6,7,8,9,10,11,13,15,17,19,23,27,31,35,43,51,59,67,83,99,115,131,163,195,227,258];
const LENGTH_BITS = [0,0,0,0,0,0,0,0,1,1,1,1,2,2,2,2,3,3,3,3,4,4,4,4,5,5,5,5,0];
const FAR_BASE = [1,2,3,4,5,7,9,13,17,25,33,49,65,97,129,193,257,385,513,769,1025,1537,2049,3073,4097,6145,8193,12289,16385,24577];
const FAR_BITS = [0,0,0,0,1,1,2,2,3,3,4,4,5,5,6,6,7,7,8,8,9,9,10,10,11,11,12,12,13,13];
const ORDER = [16,17,18,0,8,7,9,6,10,5,11,4,12,3,13,2,14,1,15];

function huffman(lengths) {
  // A table over as many bits as the longest code has: entry = symbol * 16 + length.
  let most = 0;
  for (const n of lengths) if (n > most) most = n;
  const table = new Int32Array(1 << most);
  let code = 0;
  for (let n = 1; n <= most; n++) {
    for (let symbol = 0; symbol < lengths.length; symbol++) {
      if (lengths[symbol] !== n) continue;
      let reversed = 0;
      for (let i = 0; i < n; i++) reversed |= ((code >> i) & 1) << (n - 1 - i);
      for (let i = reversed; i < table.length; i += 1 << n) table[i] = symbol * 16 + n;
      code++;
    }
    code <<= 1;
  }
  return { table, mask: (1 << most) - 1 };
}

function inflate(source, size) {
  const out = new Uint8Array(size);
  let at = 2, to = 0, hold = 0, count = 0;
  const need = n => { while (count < n) { hold |= (source[at++] || 0) << count; count += 8; } };
  const bits = n => { if (n === 0) return 0; need(n); const v = hold & ((1 << n) - 1); hold >>>= n; count -= n; return v; };
  const symbol = tree => {
    need(15);
    const entry = tree.table[hold & tree.mask], n = entry & 15;
    hold >>>= n; count -= n;
    return entry >> 4;
  };
  const fixed = new Uint8Array(288).fill(8, 0, 144).fill(9, 144, 256).fill(7, 256, 280).fill(8, 280);
  for (let last = 0; !last;) {
    last = bits(1);
    const kind = bits(2);
    if (kind === 0) {
      const drop = count & 7;
      hold >>>= drop; count -= drop;
      while (count > 0) { at--; count -= 8; }
      hold = 0; count = 0;
      const n = source[at] | (source[at + 1] << 8);
      at += 4;
      out.set(source.subarray(at, at + n), to);
      at += n; to += n;
      continue;
    }
    let near, far;
    if (kind === 1) {
      near = huffman(fixed); far = huffman(new Uint8Array(30).fill(5));
    } else {
      const n = bits(5) + 257, m = bits(5) + 1, k = bits(4) + 4, first = new Uint8Array(19);
      for (let i = 0; i < k; i++) first[ORDER[i]] = bits(3);
      const tree = huffman(first), lengths = new Uint8Array(n + m);
      for (let i = 0; i < n + m;) {
        const s = symbol(tree);
        if (s < 16) { lengths[i++] = s; continue; }
        const value = s === 16 ? lengths[i - 1] : 0;
        const times = s === 16 ? 3 + bits(2) : s === 17 ? 3 + bits(3) : 11 + bits(7);
        lengths.fill(value, i, i + times); i += times;
      }
      near = huffman(lengths.subarray(0, n)); far = huffman(lengths.subarray(n));
    }
    for (;;) {
      const s = symbol(near);
      if (s < 256) { out[to++] = s; continue; }
      if (s === 256) break;
      const n = LENGTH_BASE[s - 257] + bits(LENGTH_BITS[s - 257]), f = symbol(far);
      const back = FAR_BASE[f] + bits(FAR_BITS[f]);
      for (let i = 0; i < n; i++, to++) out[to] = out[to - back];
    }
  }
  return out;
}
