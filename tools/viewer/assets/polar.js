// Predictions over one free parameter: round for an angle (the paper's Figure 11), flat for anything else.

const ROUND = { size: 190, radius: 70 };
const FLAT = { width: 380, height: 170, left: 36, right: 10, top: 12, bottom: 22 };

/** Seconds over an angle: {values, seconds, valid, chosen, greedy, kind, caption}, and `beside` them the objective. */
function polarPlot(said) {
  const centre = ROUND.size / 2;
  const most = Math.max(...[...said.seconds, ...(said.beside ?? [])].filter((s) => s !== null), 0.1);
  const rings = ticks(0, most, 3).filter((r) => r > 0);
  const radius = scale(0, Math.max(most, rings[rings.length - 1] ?? 0), 0, ROUND.radius);
  const point = (angle, r) => [centre + r * Math.cos(angle), centre - r * Math.sin(angle)];
  const placed = (numbers) =>
    said.values.map((angle, i) => (numbers[i] === null ? null : point(angle, radius(numbers[i]))));
  const all = placed(said.seconds);
  const valid = all.map((p, i) => (said.valid[i] ? p : null));
  const drawing = svg(
    "svg",
    { viewBox: `0 0 ${ROUND.size} ${ROUND.size}`, role: "img", "aria-label": said.caption },
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
    svg("path", { class: `area ${said.kind}`, d: `${through(valid.filter((p) => p !== null))}Z` }),
    svg("path", { class: `curve invalid ${said.kind}`, d: through(all) }),
    svg("path", { class: `curve ${said.kind}`, d: through(valid) }),
    said.beside
      ? svg("path", { class: "rule", d: through(placed(said.beside)) }, svg("title", { text: "objective" }))
      : null,
    ...spoke(said, said.greedy, "lone", point, radius),
    ...spoke(said, said.chosen, "", point, radius),
  );
  const caption = html(
    "figcaption",
    {},
    said.caption,
    html("br"),
    html("b", { text: seconds(near(said, said.chosen)) }),
    ` instead of ${seconds(near(said, said.greedy))}`,
  );
  return html("figure", {}, drawing, caption);
}

function spoke(said, angle, kind, point, radius) {
  const value = near(said, angle);
  const end = point(angle, ROUND.radius + 3);
  const parts = [svg("path", { class: `mark ${kind}`, d: through([point(angle, 0), end]) })];
  if (value !== null) {
    const [cx, cy] = point(angle, radius(value));
    parts.push(svg("circle", { class: `dot ${kind}`, cx, cy, r: 3 }));
  }
  return parts;
}

/** The prediction at a value, between its neighbours; null where it is not known. */
function near(said, value) {
  const { values, seconds: s } = said;
  const step = (values[values.length - 1] - values[0]) / (values.length - 1);
  const place = Math.min(values.length - 1, Math.max(0, (value - values[0]) / (step || 1)));
  const [i, share] = [Math.floor(place), place - Math.floor(place)];
  const [a, b] = [s[i], s[Math.min(i + 1, s.length - 1)]];
  return a === null || b === null ? (a ?? b) : a + (b - a) * share;
}

/** Seconds over any other parameter, one curve an action and one for their sum: {values, curves, valid, chosen, greedy, unit}. */
function flatPlot(said) {
  const x = scale(said.values[0], said.values[said.values.length - 1], FLAT.left, FLAT.width - FLAT.right);
  const [, high] = extent(
    said.curves.flatMap((c) => c.seconds),
    0.05,
  );
  const y = scale(0, high, FLAT.height - FLAT.bottom, FLAT.top);
  const line = (curve) => {
    const all = curve.seconds.map((s, i) => (s === null ? null : [x(said.values[i]), y(s)]));
    return [
      svg("path", { class: `curve invalid ${curve.kind}`, d: through(all) }),
      svg("path", { class: `curve ${curve.kind}`, d: through(all.map((p, i) => (said.valid[i] ? p : null))) }),
    ];
  };
  const mark = (value, kind) =>
    svg("line", { class: `mark ${kind}`, x1: x(value), x2: x(value), y1: FLAT.top, y2: FLAT.height - FLAT.bottom });
  const drawing = svg(
    "svg",
    { viewBox: `0 0 ${FLAT.width} ${FLAT.height}`, role: "img", "aria-label": said.caption },
    ...ticks(0, high, 4).flatMap((v) => [
      svg("line", { class: "grid", x1: FLAT.left, x2: FLAT.width - FLAT.right, y1: y(v), y2: y(v) }),
      svg("text", { x: FLAT.left - 5, y: y(v) + 4, "text-anchor": "end", text: `${v} s` }),
    ]),
    ...ticks(x.from, x.to, 5).map((v) =>
      svg("text", { x: x(v), y: FLAT.height - 6, "text-anchor": "middle", text: quantity(v, said.unit) }),
    ),
    ...said.curves.flatMap(line),
    mark(said.greedy, "lone"),
    mark(said.chosen, ""),
  );
  return html("figure", {}, drawing, html("figcaption", {}, legend(said.curves.map((c) => [c.kind, c.name]))));
}
