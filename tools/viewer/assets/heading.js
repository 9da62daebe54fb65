// The page's top line: what runs, and how it stands at the shown moment.

class Heading {
  constructor(run, title, liveness) {
    this.run = run;
    this.title = title;
    this.liveness = liveness;
    const element = document.getElementById("heading");
    this.facts = html("span", { class: "facts" });
    this.now = html("span", { class: "now" });
    this.gone = html("strong", { class: "gone" });
    this.damage = html("strong", { class: "gone" });
    element.replaceChildren(html("h1", { text: title }), this.facts, this.now, this.gone, this.damage);
  }

  show(at) {
    this.damage.textContent = this.run.last("damage")?.text ?? "";
    const [about, state, belief] = [this.run.about(at), this.run.last("state", at), this.run.last("belief", at)];
    const action = this.run.last("action", at);
    const facts = [
      about.domain,
      state?.scenario || about.scenario,
      about.robot,
      about.horizon && `horizon ${about.horizon}`,
      about.seed !== undefined && `seed ${about.seed}`,
    ];
    this.facts.textContent = facts.filter(Boolean).join(" · ");
    const parts = [];
    if (action?.index >= 0 && belief)
      parts.push(
        html("span", { text: `${action.action} ${belief.elapsed.toFixed(1)} of ${seconds(belief.predicted, 1)}` }),
      );
    if (state?.mode) parts.push(pill(state.mode, state.reason));
    if (state?.result) parts.push(pill(state.result.split(":")[0], state.result));
    const driver = this.run.last("driver", at);
    if (driver && driver.mode !== "armed") parts.push(pill(driver.mode, driver.reason, `driver ${driver.mode}`));
    this.now.replaceChildren(...parts);
    this.warn(this.liveness.words(at));
  }

  /** What was heard last must not look like the present. */
  warn(words) {
    const { live } = this.liveness;
    const gone = words.join(", ");
    this.now.classList.toggle("past", words.length > 0);
    this.gone.textContent = gone && live ? `NOT LIVE: ${gone}. The page shows what was heard last.` : gone;
    if (live) document.title = gone ? `NOT LIVE: ${this.title}` : this.title;
  }
}

function pill(kind, reason, words = kind) {
  return html("span", {
    class: `pill ${kind}`,
    title: reason || null,
    text: reason && reason !== kind ? `${words}: ${reason.replace(/^failed: /, "")}` : words,
  });
}
