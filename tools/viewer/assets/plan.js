// The plan in execution and its progress.

class PlanGraph {
  constructor(run, target) {
    this.run = run;
    this.panel = target;
    this.drawn = "";
  }

  show(at) {
    const now = this.run.last("plan", at);
    const state = now ? this.progress(now, at) : null;
    const key = JSON.stringify([now?.at, state?.base.at, [...(state?.done ?? [])], state?.running]);
    if (key === this.drawn) return;
    this.drawn = key;
    if (now) this.lay(now, state);
    else this.panel.body.replaceChildren(html("p", { class: "empty", text: "No plan yet." }));
  }

  /** The plan as it was searched, which of its steps are done and which is running; a suffix is its rest. */
  progress(now, at) {
    const ids = (row) => new Set((row.steps ?? []).map((step) => step.id));
    let base = now;
    for (const row of this.run
      .all("plan")
      .slice(0, this.run.count("plan", at) - 1)
      .reverse()) {
      if (base.way !== "suffix" || ![...ids(base)].every((id) => ids(row).has(id))) break;
      base = row;
    }
    const left = ids(now);
    const achieved = this.run.last("state", at)?.result === "achieved";
    const done = new Set([...ids(base)].filter((id) => achieved || !left.has(id)));
    if (achieved) done.add("goal");
    const alive = !this.run.silent(at).some(([part]) => part === "executive");
    const acting = alive && (this.run.last("action", at)?.index ?? -1) >= 0;
    const running = acting ? (this.run.last("subgoals", at)?.actions[0]?.step ?? null) : null;
    return { base, done, running };
  }

  lay(now, { base, done, running }) {
    const effort = now.generated ? `, ${counted(now.generated, "plan")} generated, ${now.visited} visited` : "";
    const words = {
      suffix: "suffix of the last plan",
      improved: "better than the suffix of the last plan",
      external: "by the external planner",
    };
    const way = (words[now.way] ?? now.way) + (now.whole ? `, the next ${now.steps.length} of ${now.whole} steps` : "");
    const orderings = base.orderings?.length ? [["c1", "ordering"]] : [];
    this.panel.note.replaceChildren(
      html("span", { text: `${now.status}, ${way}${effort}${now.reason ? `: ${now.reason}` : ""}  ` }),
      legend([["c0", "causal link"], ...orderings]),
    );
    if (!base.steps?.length) {
      this.panel.body.replaceChildren(
        html("p", {
          class: "empty",
          text: base.text || (base.status === "solved" ? "No steps: the goal already holds." : "No plan."),
        }),
      );
      return;
    }
    const places = layOut(base);
    const height = Math.max(...[...places.values()].map((p) => p.y)) + GRAPH.node + 4;
    const drawing = svg(
      "svg",
      {
        viewBox: `0 0 ${GRAPH.width} ${height}`,
        role: "img",
        "aria-label": `the plan's steps with causal links and orderings: ${spoken(places, done, running)}`,
      },
      svg("defs", {}, ...["link", "start", "ordering"].map(arrowHead)),
      ...linkParts(base, places),
      ...orderingParts(base, places),
      ...[...places.values()].map((place) => nodePart(place, done, running)),
    );
    this.panel.body.replaceChildren(drawing);
    this.showRunning();
  }

  /** A long plan scrolls; its running step is kept in the middle. */
  showRunning() {
    const body = this.panel.body;
    const node = body.querySelector(".running");
    if (!node) return;
    const below = node.getBoundingClientRect().top - body.getBoundingClientRect().top;
    body.scrollTop += below - body.clientHeight / 2;
  }
}

/** The nodes of a plan in words, with how far they are. */
function spoken(places, done, running) {
  const words = ({ id, words }) => [words, stateOf(id, done, running)].filter(Boolean).join(", ");
  return [...places.values()].map(words).join("; ");
}
