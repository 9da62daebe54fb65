// Predictions over one free parameter: a polar plot for an angle (the paper's Figure 11), else curves.

const ROUND = { size: 190, radius: 70 };
const FLAT = { width: 380, height: 170, left: 36, right: 10, top: 12, bottom: 22 };

/** Seconds over an angle: {values, seconds, valid, chosen, greedy, kind, caption}, and `beside` them the objective. */
function polarPlot(plot) {
  const centre = ROUND.size / 2;
  const most = Math.max(...[...plot.seconds, ...(plot.beside ?? [])].filter((s) => s !== null), 0.1);
  const rings = ticks(0, most, 3).filter((r) => r > 0);
  const radius = scale(0, Math.max(most, rings[rings.length - 1] ?? 0), 0, ROUND.radius);
  const point = (angle, r) => [centre + r * Math.cos(angle), centre - r * Math.sin(angle)];
  const placed = (numbers) =>
    plot.values.map((angle, i) => (numbers[i] === null ? null : point(angle, radius(numbers[i]))));
  const all = placed(plot.seconds);
  const valid = all.map((p, i) => (plot.valid[i] ? p : null));
  const drawing = svg(
    "svg",
    { viewBox: `0 0 ${ROUND.size} ${ROUND.size}`, role: "img", "aria-label": plot.caption },
    ...rings.flatMap((r) => [
      svg("circle", { class: "grid", cx: centre, cy: centre, r: radius(r), fill: "none" }),
      svg("text", { x: centre + 2, y: centre - radius(r) - 1.5, text: `${r} s`, style: "font-size:9px" }),
    ]),
    ...[0, 90, 180, 270].map((degrees) => {
      const [x, y] = point((degrees * Math.PI) / 180, ROUND.radius + 12);
      return svg("text", {
        x,
        y: y + 3,
        "text-anchor": "middle",
        style: "font-size:9px",
        text: `${degrees > 180 ? degrees - 360 : degrees}°`,
      });
    }),
    svg("path", { class: `area ${plot.kind}`, d: `${through(valid.filter((p) => p !== null))}Z` }),
    svg("path", { class: `curve invalid ${plot.kind}`, d: through(all) }),
    svg("path", { class: `curve ${plot.kind}`, d: through(valid) }),
    plot.beside
      ? svg("path", { class: "rule", d: through(placed(plot.beside)) }, svg("title", { text: "objective" }))
      : null,
    ...spoke(plot, plot.greedy, "lone", point, radius),
    ...spoke(plot, plot.chosen, "", point, radius),
  );
  const caption = html(
    "figcaption",
    {},
    plot.caption,
    html("br"),
    html("b", { text: seconds(near(plot, plot.chosen)) }),
    ` instead of ${seconds(near(plot, plot.greedy))}`,
  );
  return html("figure", {}, drawing, caption);
}

function spoke(plot, angle, kind, point, radius) {
  const value = near(plot, angle);
  const end = point(angle, ROUND.radius + 3);
  const parts = [svg("path", { class: `mark ${kind}`, d: through([point(angle, 0), end]) })];
  if (value !== null) {
    const [cx, cy] = point(angle, radius(value));
    parts.push(svg("circle", { class: `dot ${kind}`, cx, cy, r: 3 }));
  }
  return parts;
}

/** The prediction at a value, interpolated; null if unknown. */
function near(plot, value) {
  const { values, seconds: s } = plot;
  const step = (values[values.length - 1] - values[0]) / (values.length - 1);
  const place = Math.min(values.length - 1, Math.max(0, (value - values[0]) / (step || 1)));
  const [i, share] = [Math.floor(place), place - Math.floor(place)];
  const [a, b] = [s[i], s[Math.min(i + 1, s.length - 1)]];
  return a === null || b === null ? (a ?? b) : a + (b - a) * share;
}

/** Seconds over any other parameter, one curve for each action and one for their sum: {values, curves, valid, chosen, greedy, unit}. */
function flatPlot(plot) {
  const x = scale(plot.values[0], plot.values[plot.values.length - 1], FLAT.left, FLAT.width - FLAT.right);
  const [, high] = extent(
    plot.curves.flatMap((c) => c.seconds),
    0.05,
  );
  const y = scale(0, high, FLAT.height - FLAT.bottom, FLAT.top);
  const line = (curve) => {
    const all = curve.seconds.map((s, i) => (s === null ? null : [x(plot.values[i]), y(s)]));
    return [
      svg("path", { class: `curve invalid ${curve.kind}`, d: through(all) }),
      svg("path", { class: `curve ${curve.kind}`, d: through(all.map((p, i) => (plot.valid[i] ? p : null))) }),
    ];
  };
  const mark = (value, kind) =>
    svg("line", { class: `mark ${kind}`, x1: x(value), x2: x(value), y1: FLAT.top, y2: FLAT.height - FLAT.bottom });
  const drawing = svg(
    "svg",
    { viewBox: `0 0 ${FLAT.width} ${FLAT.height}`, role: "img", "aria-label": plot.caption },
    ...ticks(0, high, 4).flatMap((v) => [
      svg("line", { class: "grid", x1: FLAT.left, x2: FLAT.width - FLAT.right, y1: y(v), y2: y(v) }),
      svg("text", { x: FLAT.left - 5, y: y(v) + 4, "text-anchor": "end", text: `${v} s` }),
    ]),
    ...ticks(x.from, x.to, 5).map((v) =>
      svg("text", { x: x(v), y: FLAT.height - 6, "text-anchor": "middle", text: quantity(v, plot.unit) }),
    ),
    ...plot.curves.flatMap(line),
    mark(plot.greedy, "lone"),
    mark(plot.chosen, ""),
  );
  return html("figure", {}, drawing, html("figcaption", {}, legend(plot.curves.map((c) => [c.kind, c.name]))));
}
