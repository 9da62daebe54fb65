// A plan as a graph: steps from top to bottom, causal links solid with what they carry, bare orderings dashed.

const SIGNS = { done: "m0 0l2.5 3l4 -6.5", running: "m0 -4l6 4l-6 4z" }; // a tick, a triangle: not all see colours
const GRAPH = { width: 560, row: 74, tight: 52, node: 26, glyph: 6.7, many: 6 };

/** Where each node stands, by id (0: the initial state, "goal"): levels by the longest way from the start. */
function layOut(plan) {
  const edges = [...plan.links.map((l) => [l.from, l.to]), ...plan.orderings];
  const level = new Map([[0, 0], ...plan.steps.map((step) => [step.id, 1])]);
  for (let round = 0; round < plan.steps.length; round += 1) {
    for (const [from, to] of edges)
      if (to !== "goal" && from !== 0) level.set(to, Math.max(level.get(to), level.get(from) + 1));
  }
  const deepest = Math.max(...level.values());
  level.set("goal", deepest + 1);
  const words = new Map([
    [0, "initial state"],
    ["goal", "goal"],
    ...plan.steps.map((step) => [step.id, step.words.join(" ")]),
  ]);
  const places = new Map();
  const row = plan.steps.length > GRAPH.many ? GRAPH.tight : GRAPH.row;
  for (let at = 0; at <= deepest + 1; at += 1) {
    const here = [...level.keys()].filter((id) => level.get(id) === at);
    here.forEach((id, i) => {
      const width = Math.min(GRAPH.width / here.length - 8, words.get(id).length * GRAPH.glyph + 22);
      places.set(id, {
        id,
        words: words.get(id),
        level: at,
        x: (GRAPH.width * (i + 0.5)) / here.length,
        y: at * row + 2,
        width,
      });
    });
  }
  return places;
}

/** How far a node is: running, done or neither. */
function stateOf(id, done, running) {
  return id === running ? "running" : done.has(id) ? "done" : "";
}

function nodePart(place, done, running) {
  const state = stateOf(place.id, done, running);
  const [x, y] = [place.x - place.width / 2, place.y];
  return svg(
    "g",
    { class: `node ${state}`.trim(), "data-step": place.id },
    svg("rect", { x, y, width: place.width, height: GRAPH.node, rx: 6 }),
    state ? svg("path", { class: "sign", d: `M${x + 4} ${y + GRAPH.node / 2}${SIGNS[state]}` }) : null,
    svg("text", {
      class: "ink",
      x: place.x,
      y: y + 17,
      "text-anchor": "middle",
      style: "font-size:12px",
      text: place.words,
    }),
  );
}

/** One line for all links between two nodes, with their literals beside it. */
function linkParts(plan, places) {
  const bundles = new Map();
  for (const link of plan.links) {
    const key = `${link.from} ${link.to}`;
    if (!bundles.has(key)) bundles.set(key, { from: places.get(link.from), to: places.get(link.to), literals: [] });
    bundles.get(key).literals.push(link.literal);
  }
  const crowded = plan.steps.length > GRAPH.many; // then what holds from the start is written beside its step
  const drawn = [...bundles.values()].map(({ from, to, literals }) => {
    if (crowded && from.id === 0 && to.level > 1) {
      const words = `${literals.join(" ")} →`;
      return [null, [svg("text", { x: to.x - to.width / 2 - 6, y: to.y + 17, "text-anchor": "end", text: words })]];
    }
    const kind = from.id === 0 ? "start" : "link";
    const line = route(from, to, from.id === 0 && to.level > 1 ? -1 : 1);
    const shown = literals.length > 3 ? [...literals.slice(0, 2), `and ${literals.length - 2} more`] : literals;
    const label = shown.map((words, i) =>
      svg("text", {
        class: "halo",
        x: line.x + line.side * 6,
        y: line.y + 3 + (i - (shown.length - 1) / 2) * 12,
        "text-anchor": line.side < 0 ? "end" : "start",
        text: words,
      }),
    );
    return [
      svg(
        "path",
        { class: `link ${kind}`, d: line.d, "marker-end": `url(#head-${kind})` },
        svg("title", { text: literals.join(" ") }),
      ),
      label,
    ];
  });
  return [...drawn.map(([line]) => line).filter(Boolean), ...drawn.flatMap(([, label]) => label)]; // words above all lines
}

function orderingParts(plan, places) {
  return plan.orderings.map(([before, after]) => {
    const line = route(places.get(before), places.get(after), 1, 26);
    return svg(
      "path",
      { class: "ordering", d: line.d, "marker-end": "url(#head-ordering)" },
      svg("title", { text: "ordering" }),
    );
  });
}

/** A curve from one node to another; long ones leave and arrive at a side, and pass the nodes between. */
function route(from, to, side, shift = 0) {
  const span = to.level - from.level;
  if (span <= 1) {
    const [x1, y1, x2, y2] = [from.x + shift, from.y + GRAPH.node, to.x + shift, to.y - 5];
    const bend = (y2 - y1) / 2;
    return {
      d: `M${x1} ${y1}C${x1} ${y1 + bend} ${x2} ${y2 - bend} ${x2} ${y2}`,
      side,
      x: (x1 + x2) / 2,
      y: (y1 + y2) / 2,
    };
  }
  const [x1, x2] = [from.x + (side * from.width) / 2, to.x + side * (to.width / 2 + 5)];
  const [y1, y2] = [from.y + GRAPH.node / 2, to.y + GRAPH.node / 2];
  const widest = Math.max(x1 * side, x2 * side) * side + side * Math.min(22 * span, 130);
  return {
    d: `M${x1} ${y1}C${widest} ${y1} ${widest} ${y2} ${x2} ${y2}`,
    side,
    x: (x1 + x2) / 8 + widest * 0.75,
    y: (y1 + y2) / 2,
  };
}

function arrowHead(kind) {
  return svg(
    "marker",
    {
      id: `head-${kind}`,
      viewBox: "0 0 8 8",
      refX: 6,
      refY: 4,
      markerWidth: 6.5,
      markerHeight: 6.5,
      orient: "auto-start-reverse",
    },
    svg("path", { class: `arrow-${kind}`, d: "M0 0L8 4L0 8z" }),
  );
}
