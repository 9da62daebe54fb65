// Numbers to pixels, and round numbers to label them with.

/** A linear map from [from, to] to [low, high]. */
function scale(from, to, low, high) {
  const factor = to === from ? 0 : (high - low) / (to - from);
  const map = (value) => low + (value - from) * factor;
  map.invert = (pixel) => (factor === 0 ? from : from + (pixel - low) / factor);
  map.from = from;
  map.to = to;
  return map;
}

/** Round numbers in [from, to], about `count` of them. */
function ticks(from, to, count) {
  const span = to - from;
  if (!(span > 0)) return [from];
  const raw = span / Math.max(1, count);
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map((f) => f * power).find((s) => s >= raw * 0.999);
  const found = [];
  for (let k = Math.ceil(from / step - 1e-9); k * step <= to + step * 1e-6; k += 1)
    found.push(Number((k * step).toPrecision(12)));
  return found;
}

/** Smallest and largest of the numbers, widened by a share of their distance; [0, 1] where there are none. */
function extent(values, margin = 0.06) {
  let low = Infinity;
  let high = -Infinity;
  for (const value of values) {
    if (value === null || value === undefined || Number.isNaN(value)) continue;
    if (value < low) low = value;
    if (value > high) high = value;
  }
  if (low > high) return [0, 1];
  const pad = (high - low || Math.abs(high) || 1) * margin;
  return [low - pad, high + pad];
}

/** The value below which a share of the numbers lies. */
function quantile(values, share) {
  if (!values.length) return null;
  const sorted = [...values].sort((a, b) => a - b);
  return sorted[Math.min(sorted.length - 1, Math.floor(share * sorted.length))];
}
