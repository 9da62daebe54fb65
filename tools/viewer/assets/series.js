// Small multiples over time: every value of the belief, for a robot that is more than a place with a heading.

const PLOT = { width: 380, height: 92, left: 40, right: 8, top: 16, bottom: 16 };

class Series {
  constructor(run, target) {
    this.run = run;
    this.panel = target;
    this.drawn = -1;
    [this.believed, this.rest, this.summary] = [html("div"), html("div"), html("summary")];
    this.more = html("details", {}, this.summary, this.rest); // stays: a new one on each event could not be clicked at
  }

  show(at, view) {
    if (!this.more.isConnected) this.panel.body.replaceChildren(this.believed, this.more);
    this.episode = this.run.episode(at);
    const key = `${this.run.version} ${view[0]} ${view[1]} ${this.episode[0]}`;
    if (this.drawn !== key) {
      this.drawn = key;
      this.lay(view);
    }
    for (const plot of this.plots) plot.move(at);
  }

  lay(view) {
    const [beliefs, others] = [this.beliefs(), this.others()].map((lines) => lines.map((line) => timePlot(line, view)));
    this.plots = [...beliefs, ...others];
    this.believed.replaceChildren(
      beliefs.length ? plotGrid(beliefs) : html("p", { class: "empty", text: "No numbers yet." }),
    );
    this.summary.textContent = `${others.length} more: sensors and commands`;
    this.rest.replaceChildren(plotGrid(others));
    this.more.hidden = others.length === 0;
    this.panel.title.textContent = "State";
    this.panel.note.textContent = beliefs.length
      ? "believed values; dots: goals of the actions at their end, hollow: free parameters"
      : "";
  }

  goalOf(action) {
    return this.run.last("subgoals", action.begin + 0.15)?.actions[0]?.parameters ?? [];
  }

  /** The belief's values, each with the goals that the actions had for a parameter of that name. */
  beliefs() {
    const names = this.run.about().beliefNames ?? [];
    const rows = this.run.all("belief");
    const count = rows.reduce((most, row) => Math.max(most, row.values.length), 0); // runs may believe more or less
    return Array.from({ length: count }, (_, i) => {
      const name = names[i] ?? `belief ${i}`;
      return { name, points: rows.map((row) => [row.at, row.values[i] ?? null]), goals: this.goals(bare(name)) };
    });
  }

  goals(name) {
    return this.run.actions().flatMap((action) => {
      const goal = this.goalOf(action).find((p) => p.name === `${name}g`);
      return goal ? [[action.until, goal.value, goal.bound]] : [];
    });
  }

  /** Series of topics without a view of their own, except constant ones. */
  others() {
    return this.run.series().flatMap((kind) => {
      const rows = this.run.all(kind);
      const names = new Set(rows.flatMap(Object.keys)); // not of the first row alone: each joint may have its publisher
      names.delete("at");
      const lines = [...names].map((name) => ({
        name: `${kind.slice(7)} ${name}`,
        points: rows.filter((row) => name in row).map((row) => [row.at, row[name]]),
        goals: [],
      }));
      return lines
        .filter((line) => line.points.some(([, value]) => Math.abs(value - line.points[0][1]) > 1e-3))
        .slice(0, 24);
    });
  }
}

/** A belief's name without its unit, as parameters have it. */
function bare(name) {
  return name.split(" (")[0].replace(/ /g, "_");
}

function plotGrid(plots) {
  return html(
    "div",
    { class: "plots", style: "grid-template-columns:repeat(auto-fit,minmax(17rem,1fr))" },
    ...plots.map((p) => p.element),
  );
}

/** One plot over time with a cursor that moves. */
function timePlot(line, [from, to]) {
  const seen = line.points.filter(([at, value]) => at >= from && at <= to && value !== null);
  const [low, high] = extent([...seen.map((p) => p[1]), ...line.goals.map((g) => g[1])], 0.1);
  const x = Object.assign(scale(from, to, PLOT.left, PLOT.width - PLOT.right), { shows: () => true });
  const y = scale(low, high, PLOT.height - PLOT.bottom, PLOT.top);
  const cursor = svg("line", { class: "cursor", y1: PLOT.top, y2: PLOT.height - PLOT.bottom });
  const now = svg("text", { class: "ink", x: PLOT.width - PLOT.right, y: 10, "text-anchor": "end" });
  const element = svg(
    "svg",
    { viewBox: `0 0 ${PLOT.width} ${PLOT.height}` },
    ...ticks(low, high, 3).flatMap((v) => [
      svg("line", { class: "grid", x1: PLOT.left, x2: PLOT.width - PLOT.right, y1: y(v), y2: y(v) }),
      svg("text", { x: PLOT.left - 4, y: y(v) + 3.5, "text-anchor": "end", text: String(v) }),
    ]),
    svg("path", { class: "trace c0", d: curveOf(seen, x, y) }),
    ...line.goals
      .filter(([at]) => at >= from && at <= to)
      .map(([at, value, bound]) => svg("circle", { class: bound ? "dot" : "dot lone", cx: x(at), cy: y(value), r: 3 })),
    svg("text", { class: "strong", x: PLOT.left, y: 10, text: line.name }),
    now,
    cursor,
  );
  const move = (at) => {
    const px = x(Math.min(to, Math.max(from, at)));
    cursor.setAttribute("x1", px);
    cursor.setAttribute("x2", px);
    const last = seen[countUpTo(seen, at, (p) => p[0]) - 1];
    now.textContent = last ? last[1].toFixed(3) : "";
  };
  return { element, move };
}
