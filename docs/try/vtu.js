// Reads the .vtu files that delmesher writes: arrays as text, or in base 64 behind their size.
const kTypes = {
  Float64: Float64Array, Int64: BigInt64Array, Int32: Int32Array, Int8: Int8Array, UInt8: Uint8Array,
};

function numbers(type, format, text) {
  if (format === "ascii") return Float64Array.from(text.trim() === "" ? [] : text.trim().split(/\s+/), Number);
  const raw = atob(text.trim()), bytes = new Uint8Array(raw.length);
  for (let n = 0; n < raw.length; ++n) bytes[n] = raw.charCodeAt(n);
  return new kTypes[type](bytes.buffer.slice(8));
}

/** Points, and the cells by number of corners: `cells[3]` has three corners after the other. Arrays by cell are in `arrays`. */
export function read_vtu(bytes) {
  const arrays = {}, text = new TextDecoder().decode(bytes);
  for (const [, attributes, content] of text.matchAll(/<DataArray ([^>]*)>([^<]*)<\/DataArray>/g)) {
    const [type, name, format] = ["type", "Name", "format"].map((key) => attributes.match(new RegExp(`\\b${key}="([^"]*)"`))[1]);
    arrays[name] = numbers(type, format, content);
  }
  const cells = { 2: [], 3: [], 4: [] }, { connectivity, offsets } = arrays;
  for (let cell = 0, at = 0; cell < offsets.length; ++cell) {
    const end = Number(offsets[cell]), list = cells[end - at];
    for (; at < end; ++at) list.push(connectivity[at]);
  }
  return { points: arrays.Points, cells, arrays };
}
