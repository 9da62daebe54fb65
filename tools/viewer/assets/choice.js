// The chosen values of the free parameters, the greedy ones, and the predictions for their alternatives.

class ChoicePanel {
  constructor(run, target, player) {
    this.run = run;
    this.panel = target;
    this.player = player;
    this.picked = null; // "place quantity" of the parameter whose alternatives are shown
    this.drawn = "";
  }

  show(at) {
    const [subgoals, report] = [this.run.last("subgoals", at), this.run.last("refinement", at)];
    const why = this.run.last("why", at);
    const fitting = why && subgoals && why.at === subgoals.at ? why : null;
    this.panel.note.textContent = report ? this.search(report) : "";
    // Not of the report, which comes with each tick of a search: a new button on each could not be pressed.
    const key = [subgoals?.at, fitting?.at, this.picked, subgoals && this.firstIndex(subgoals.at)].join(" ");
    if (key === this.drawn) return;
    this.drawn = key;
    this.again = () => {
      this.drawn = "";
      this.show(at);
    };
    const focused = this.buttons().indexOf(document.activeElement);
    if (!subgoals) this.panel.body.replaceChildren(html("p", { class: "empty", text: "No subgoals yet." }));
    else this.panel.body.replaceChildren(...(fitting ? this.explained(fitting) : this.listed(subgoals)));
    this.buttons()[focused]?.focus();
  }

  buttons() {
    return [...this.panel.body.querySelectorAll("button")];
  }

  search(report) {
    const state = report.finished ? "search finished" : "searching";
    const effort = `${counted(report.evaluations, "evaluation")} in ${counted(report.checks, "check")}`;
    const found =
      report.greedy === null || report.best === null
        ? ""
        : `, objective ${report.greedy.toFixed(2)} → ${seconds(report.best)}`;
    const gap = report.gap === null ? "" : `, within ${report.gap.toFixed(1)} % of the models' optimum`;
    return `${report.solver}: ${effort}${found}, ${state}${gap}`;
  }

  /** With models: chosen against greedy values, and the alternatives. */
  explained(why) {
    const free = why.parameters;
    const key = (a) => `${a.place} ${a.quantity}`;
    const shown = free.find((a) => key(a) === this.picked) ?? free.find((a) => a.periodic) ?? free[0];
    const chips = free.map((a) =>
      html(
        "button",
        {
          type: "button",
          "aria-pressed": a === shown,
          onclick: () => {
            this.picked = key(a);
            this.again();
          },
        },
        `${a.quantity} at ${a.place}: ${quantity(a.chosen, a.unit)} (greedy ${quantity(a.greedy, a.unit)})`,
      ),
    );
    return [
      ...(why.avoided ? [this.avoided(why.avoided)] : []),
      this.verdict(why),
      this.table(why, sum(why.chosen), sum(why.greedy)),
      html("div", { class: "chips", role: "group", "aria-label": "free parameter" }, ...chips),
      this.plots(why, shown),
    ];
  }

  /** Why a subgoal was asserted. */
  avoided({ action, straight, by_subgoal }) {
    const share = (p) => (p === null ? "–" : `${(100 * p).toFixed(0)} %`);
    const words = `: straight to its goal ${action} is predicted to fail with ${share(straight)}, this way with ${share(by_subgoal)}.`;
    return html("p", { class: "verdict" }, html("b", { text: "By way of a subgoal" }), words);
  }

  /** The objective of refinement: duration, its spread, and the risk of failure. */
  verdict(why) {
    const [chosen, greedy] = why.cost;
    const words = why.actions.length === 1 ? "the next action" : `the next ${why.actions.length} actions`;
    if (greedy === null || chosen === null)
      return html(
        "p",
        { class: "verdict" },
        html("b", { text: greedy === null ? "Greedy is predicted to fail" : "Accepted although predicted to fail" }),
        `, over ${words}.`,
      );
    const saved = greedy - chosen;
    const verdict =
      Math.abs(saved) < 0.005
        ? "as good as greedy"
        : `${Math.abs(saved).toFixed(2)} s ${saved > 0 ? "better" : "worse"} than greedy (${((100 * Math.abs(saved)) / greedy).toFixed(1)} %)`;
    return html("p", { class: "verdict" }, html("b", { text: verdict }), ` in the objective over ${words}${traded(why)}.`);
  }

  table(why, chosen, greedy) {
    const cells = (...words) => words.map((text) => html("td", { text }));
    const first = this.firstIndex(why.at);
    const rows = why.actions.map((action, i) =>
      html(
        "tr",
        {},
        html("td", {}, html("span", { class: `key ${colour(first + i)}` }), action),
        ...cells(seconds(why.chosen[i]), seconds(why.greedy[i]), signed(why.chosen[i] - why.greedy[i], 2)),
      ),
    );
    return html(
      "table",
      {},
      html("tr", {}, ...["predicted", "chosen", "greedy", "difference"].map((text) => html("th", { text }))),
      ...rows,
      html("tr", { class: "sum" }, ...cells("sum", seconds(chosen), seconds(greedy), signed(chosen - greedy, 2))),
      html(
        "tr",
        { title: "objective of refinement: duration, its spread, and the risk of failure" },
        ...cells(
          "objective",
          ...why.cost.map((s) => seconds(s)),
          why.cost.includes(null) ? "" : signed(why.cost[0] - why.cost[1], 2),
        ),
      ),
    );
  }

  plots(why, parameter) {
    const first = this.firstIndex(why.at);
    const curves = parameter.touched.map((i, k) => ({
      name: why.actions[i],
      seconds: parameter.seconds[k],
      kind: colour(first + i),
    }));
    const both =
      parameter.touched.length > 1 || why.actions.length > 1
        ? [{ name: "sum", seconds: parameter.total, kind: "sum", beside: parameter.cost }]
        : [];
    const common = {
      values: parameter.values,
      valid: parameter.cost.map((s) => s !== null),
      chosen: parameter.chosen,
      greedy: parameter.greedy,
      unit: parameter.unit,
    };
    if (!parameter.periodic)
      return flatPlot({ ...common, curves: [...curves, ...both], caption: `${parameter.quantity} at ${parameter.place}` });
    return html(
      "div",
      { class: "plots" },
      ...[...curves, ...both].map((c) =>
        polarPlot({ ...common, seconds: c.seconds, beside: c.beside, kind: c.kind, caption: c.name }),
      ),
    );
  }

  /** Index of the first action of a decision, for its colour. */
  firstIndex(at) {
    const running = this.run.actions().find((a) => a.until > at + 0.15); // the end of the last action is published late
    return running?.index ?? 0;
  }

  /** Without models: the contents of the messages. */
  listed(subgoals) {
    const seen = new Set(); // parameters with equal ids are one variable
    const rows = subgoals.actions.flatMap((action) =>
      action.parameters
        .filter((p) => !p.bound && !seen.has(p.id) && seen.add(p.id))
        .map((p) => [
          `${action.action}: ${p.name} at ${p.place}`,
          quantity(p.value, p.unit),
          `${quantity(p.lower, p.unit)} … ${quantity(p.upper, p.unit)}`,
        ]),
    );
    const durations = subgoals.actions
      .slice(0, subgoals.horizon)
      .map((action) => [action.action, seconds(action.predicted), `± ${seconds(action.spread)}`]);
    const table = (head, body) =>
      html(
        "table",
        {},
        html("tr", {}, ...head.map((text) => html("th", { text }))),
        ...body.map((row) => html("tr", {}, ...row.map((text) => html("td", { text })))),
      );
    return [
      table(["action", "predicted", "spread"], durations),
      rows.length
        ? table(["free parameter", "chosen", "range"], rows)
        : html("p", { class: "empty" }, "No parameter was free. ", ...this.lastChoice(subgoals.at)),
    ];
  }

  /** The way back to the last decision with something to choose: a run that has ended shows its last one, mostly fixed. */
  lastChoice(at) {
    const last = this.run.between("subgoals", this.run.episode(at)[0], at).findLast(hasFree);
    if (!last) return [];
    const go = { type: "button", onclick: () => this.player.go(last.at) };
    return ["The last choice: ", html("button", go, seconds(last.at))];
  }
}

/** Whether a decision chose the value of a parameter. */
function hasFree(subgoals) {
  return subgoals.actions.some((action) => action.parameters.some((p) => !p.bound));
}

/** What was paid for what, in words: the action that takes most longer than by greedy values, and that which takes most less. */
function traded(why) {
  if ([...why.chosen, ...why.greedy].includes(null)) return "";
  const longer = why.actions.map((_, i) => why.chosen[i] - why.greedy[i]);
  const [most, least] = [Math.max(...longer), Math.min(...longer)];
  if (!(most >= 0.005 && least <= -0.005)) return "";
  const name = (i) => why.actions[i] + (why.actions.filter((a) => a === why.actions[i]).length > 1 ? ` (${i + 1})` : "");
  const [slow, quick] = [name(longer.indexOf(most)), name(longer.indexOf(least))];
  return `: ${slow} takes ${seconds(most)} longer than by the greedy choice, ${quick} ${seconds(-least)} less`;
}

function sum(values) {
  return values.reduce((total, value) => total + value, 0);
}
