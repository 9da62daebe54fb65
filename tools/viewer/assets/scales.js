// Numbers to pixels, and round numbers to label them with.

const PAUSE_S = 1; // of a curve: longer, and many times as long as between its other points
const PAUSE_STEPS = 10;

/** A linear map from [from, to] to [low, high]. */
function scale(from, to, low, high) {
  const factor = to === from ? 0 : (high - low) / (to - from);
  const map = (value) => low + (value - from) * factor;
  map.invert = (pixel) => (factor === 0 ? from : from + (pixel - low) / factor);
  map.from = from;
  map.to = to;
  return map;
}

/** Round numbers in [from, to], about `count` of them; `from` alone where floats are too coarse for more. */
function ticks(from, to, count) {
  const span = to - from;
  if (!(span > 0)) return [from];
  const raw = span / Math.max(1, count);
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map((f) => f * power).find((s) => s >= raw * 0.999);
  const most = Math.max(Math.abs(from), Math.abs(to)) / step;
  if (!(most < Number.MAX_SAFE_INTEGER)) return [from]; // the number after k is k: the loop would not end
  const found = [];
  for (let k = Math.ceil(from / step - 1e-9); k * step <= to + step * 1e-6; k += 1)
    found.push(Number((k * step).toPrecision(12)));
  return found;
}

/** Likewise, but at least two of them well inside: one number alone gives an axis no scale. */
function atLeastTwo(from, to, count) {
  const inside = (to - from) / 10;
  const found = ticks(from, to, count);
  const enough = found.filter((v) => v > from + inside && v < to - inside).length > 1;
  return enough || count > 20 ? found : atLeastTwo(from, to, 1.5 * count);
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

/** Of the shown events [{at}] that fall on one pixel, the one with the largest value: the eye cannot tell them apart. */
function onePerPixel(rows, x, value = () => 0) {
  const kept = new Map();
  for (const row of rows) {
    if (!x.shows(row.at)) continue;
    const px = Math.round(x(row.at));
    const other = kept.get(px);
    if (!other || value(row) > value(other)) kept.set(px, row);
  }
  return [...kept.values()];
}

/** Of the shown points [at, value], at most four of each pixel: first, lowest, highest and last, so that no peak is lost. */
function outermost(points, x) {
  const kept = [];
  let px = null;
  let pixel = [];
  const close = () => {
    if (pixel.length <= 4) kept.push(...pixel);
    else {
      const by = (better) => pixel.reduce((a, b) => (b[1] !== null && (a[1] === null || better(b[1], a[1])) ? b : a));
      const outer = new Set([pixel[0], by((b, a) => b < a), by((b, a) => b > a), pixel[pixel.length - 1]]);
      kept.push(...pixel.filter((point) => outer.has(point)));
    }
    pixel = [];
  };
  for (const point of points) {
    if (!x.shows(point[0])) continue;
    const here = Math.round(x(point[0]));
    if (here !== px) close();
    px = here;
    pixel.push(point);
  }
  close();
  return kept;
}

/** Points with a null between two that are far apart in time: what was meanwhile is not known. */
function interrupted(points, whole) {
  const steps = points.slice(1).map(([at], i) => at - points[i][0]);
  const pause = Math.max(PAUSE_S, PAUSE_STEPS * quantile(steps, 0.5));
  return points.flatMap((point, i) => {
    const before = points[i - 1];
    const joined = i === 0 || steps[i - 1] <= pause || (!whole && point[1] === before[1]);
    return joined ? [point] : [[(before[0] + point[0]) / 2, null], point];
  });
}

/**
 * A path through the shown points [at, value], interrupted where they pause. Between equal ones it is not, since those
 * that repeat their neighbours may be left out (columns.py), unless there is the `whole` of them.
 */
function curveOf(points, x, y, whole = false) {
  const shown = points.filter(([at]) => x.shows(at));
  const kept = outermost(interrupted(shown, whole), x);
  return through(kept.map(([at, value]) => (value === null ? null : [x(at), y(value)])));
}
