// The timeline's lanes: each draws one kind of thing over a common scale of time, from a top edge downwards.

/** Actions: predicted (pale, above) against actual (full, below). */
function actionLane(run, x, top) {
  const parts = [];
  for (const [i, action] of run.actions().entries()) {
    const next = run.actions()[i + 1];
    const [left, right] = [x(action.begin), x(action.until)];
    if (right < x.low || left > x.high) continue;
    const bar = (kind, until, y) => {
      const [begin, end] = [Math.max(x.low, left), Math.min(x.high, x(until))];
      return svg("rect", {
        class: `bar ${kind} ${colour(action.index)}`,
        x: begin,
        y,
        width: Math.max(1.5, end - begin - 1),
        height: 9,
        rx: 2,
      });
    };
    parts.push(bar("predicted", action.begin + action.predicted, top + 16));
    const outcome = action.ended?.outcome ?? "done";
    const kind = outcome === "done" ? "actual" : outcome === "aborted" ? "actual aborted" : "actual failed";
    parts.push(bar(kind, action.until, top + 27));
    const bars = parts.splice(-2);
    if (outcome !== "done" && outcome !== "aborted") bars.push(cross(Math.min(x.high, right), right - left, top + 31.5));
    const words = action.ended
      ? `${action.action}  ${action.ended.actual.toFixed(1)} s (${signed(action.ended.actual - action.predicted)})`
      : action.action;
    const free = next ? x(next.begin) - 4 : Math.max(right, x(action.begin + action.predicted));
    const room = free - Math.max(x.low, left);
    const short = room > 6.2 * words.length ? words : room > 6.2 * action.action.length ? action.action : "";
    const label = svg("text", { class: "ink", x: Math.max(x.low, left), y: top + 11, text: short });
    const reason = action.ended?.reason ? `, ${action.ended.outcome}: ${action.ended.reason}` : "";
    parts.push(
      svg(
        "g",
        {},
        svg("title", {
          text: `${action.action}: predicted ${seconds(action.predicted)}, actual ${seconds(action.until - action.begin)}${reason}`,
        }),
        label,
        ...bars,
      ),
    );
  }
  return parts;
}

/** A cross at the end of a bar, which is as red as it: whoever sees no colours knows a failure by it. */
function cross(end, width, y) {
  const fits = width > 14;
  const px = end - (fits ? 7 : width / 2);
  return svg("path", { class: fits ? "cross" : "cross narrow", d: `M${px - 3} ${y - 3}l6 6M${px - 3} ${y + 3}l6 -6` });
}

/** What happened when: decisions (diamond), plans (square), changes of mode (line). */
function eventLane(run, x, top) {
  const y = top + 8;
  const mark = (row, shape, words) =>
    svg("g", {}, svg("title", { text: `${row.at.toFixed(1)} s: ${words}` }), shape(x(row.at)));
  const diamond = (px) => svg("path", { d: `M${px} ${y - 4}l4 4l-4 4l-4 -4z`, style: "fill:var(--good)" });
  const square = (px) => svg("rect", { x: px - 3.2, y: y - 3.2, width: 6.4, height: 6.4, style: "fill:var(--a0)" });
  const post = (px) => svg("line", { class: "event", x1: px, x2: px, y1: y - 6, y2: y + 6 });
  const shown = (kind) => onePerPixel(run.all(kind), x);
  return [
    ...shown("state").map((row) => mark(row, post, [row.mode, row.reason, row.result].filter(Boolean).join(" · "))),
    ...shown("plan").map((row) => mark(row, square, `plan ${row.status} (${row.way})`)),
    ...shown("subgoals").map((row) => mark(row, diamond, "subgoals chosen")),
  ];
}

/** Curves with an axis: [{points: [[at, value]], kind, whole: see `curveOf`}]. */
function curveLane(x, top, height, lines, [low, high], unit) {
  const y = scale(low, high, top + height - 4, top + 8);
  const labels = ticks(low, high, 3).flatMap((v) => [
    svg("line", { class: "grid", x1: x.low, x2: x.high, y1: y(v), y2: y(v) }),
    svg("text", { x: x.low - 6, y: y(v) + 4, "text-anchor": "end", text: String(v) }),
  ]);
  const curves = lines.map(({ kind, points, whole }) => svg("path", { class: kind, d: curveOf(points, x, y, whole) }));
  return [...labels, svg("text", { x: x.high + 6, y: top + 14, text: unit }), ...curves];
}

/** Ticks: control (full) and the whole of the work (pale) in ms, the largest of each pixel; lateness above 1 ms; limits. */
function tickLane(run, x, top, height, times) {
  const rows = run.all("tick").filter((row) => x.shows(row.at));
  const high = rows.reduce((most, row) => Math.max(most, Math.min(row.work, 2 * times.period)), times.period * 1.05);
  const y = scale(0, high, top + height - 4, top + 6);
  const column = (value) =>
    columns(rows, x, value)
      .map(([px, v]) => `M${px} ${y(0).toFixed(1)}V${y(Math.min(v, high)).toFixed(1)}`)
      .join("");
  const width = Math.max(1, Math.min(5, ((x.high - x.low) / Math.max(1, rows.length)) * 0.7));
  const limits = [
    [times.budget, "budget"],
    [times.period, "period"],
  ].flatMap(([v, words]) => [
    svg("line", { class: "limit", x1: x.low, x2: x.high, y1: y(v), y2: y(v) }),
    svg("text", { x: x.high + 6, y: y(v) + 4, text: words }),
    svg("text", { x: x.low - 6, y: y(v) + 4, "text-anchor": "end", text: String(v) }),
  ]);
  const late = onePerPixel(
    rows.filter((row) => row.late > 1),
    x,
    (row) => row.late,
  ).map((row) => svg("circle", { class: "late", cx: x(row.at), cy: y(Math.min(row.late, high)), r: 1.8 }));
  const missed = onePerPixel(
    rows.filter((row) => row.skipped > 0),
    x,
  ).map((row) =>
    svg("rect", { class: "late", x: x(row.at) - 1.5, y: top + 2, width: 3, height: height - 6, opacity: 0.35 }),
  );
  return [
    ...missed,
    svg("path", { style: `stroke:var(--a0);opacity:.4;stroke-width:${width}`, d: column((row) => row.work) }),
    svg("path", { style: `stroke:var(--a0);stroke-width:${width}`, d: column((row) => row.control) }),
    ...limits,
    ...late,
    svg("text", { x: x.low - 6, y: y(0) + 3, "text-anchor": "end", text: "0" }),
  ];
}

/** The largest value of each pixel column: [[pixel, value]]. */
function columns(rows, x, value) {
  const found = new Map();
  for (const row of rows) {
    const px = Math.round(x(row.at) * 2) / 2;
    found.set(px, Math.max(found.get(px) ?? 0, value(row) ?? 0));
  }
  return [...found];
}
