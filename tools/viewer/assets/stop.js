// The stop button of a live page: a press stops every driver; then it shows what each of them confirms.

const STOP_WAIT_MS = 4000; // longer than the server waits for the drivers
const TOKEN_WAIT_MS = 3000; // longer than a page waits before it connects again

class StopButton {
  /** `token` gives the server's present token. */
  constructor(run, token) {
    this.run = run;
    this.token = token;
    this.outcome = html("span", { class: "outcome", role: "alert" });
    const title = "emergency stop of every driver";
    const button = html("button", { class: "stop", type: "button", text: "STOP", title, onclick: () => this.press() });
    this.element = html("div", { class: "stopping" }, button, this.outcome);
    this.confirmedAt = null; // the time of the run, while the outcome holds
  }

  async press() {
    this.confirmedAt = null;
    this.outcome.className = "outcome";
    this.outcome.textContent = "stopping …";
    const pressedAt = new Date().toLocaleTimeString("en-GB");
    const [confirmed, words] = await pressed(this.token);
    this.confirmedAt = confirmed ? this.run.end : null;
    this.outcome.className = confirmed ? "outcome confirmed" : "outcome failed";
    this.outcome.textContent = `${pressedAt}: ${words}`;
  }

  /** A driver that was released since is stopped no longer, so the outcome goes. */
  show() {
    const { at, mode } = this.run.last("driver") ?? {};
    if (this.confirmedAt !== null && at > this.confirmedAt && mode !== "estopped") this.forget();
  }

  /** Another run: what drivers of the last one confirmed says nothing about its drivers. */
  forget() {
    if (this.confirmedAt === null) return; // what was not confirmed stays until the next press
    this.confirmedAt = null;
    this.outcome.className = "outcome";
    this.outcome.textContent = "";
  }
}

/** Whether every driver has confirmed, and the words for it. A server that was restarted refuses the old token. */
async function pressed(token) {
  const old = token();
  try {
    let response = await post(old);
    if (response.status === 403 && (await renewed(token, old))) response = await post(token());
    if (!response.ok) return [false, `refused (${response.status}); use tailor estop`];
    const { confirmed, drivers, connected } = await response.json();
    if (!connected) return [false, "NOT CONFIRMED: the viewer is not connected to the bus; use tailor estop"];
    const modes = Object.entries(drivers).map(([robot, mode]) => `${robot} is ${mode}`);
    return [confirmed, modes.join(", ") || "NOT CONFIRMED: no driver is heard on the bus"];
  } catch {
    return [false, "NOT CONFIRMED: the viewer does not respond; use tailor estop"];
  }
}

function post(token) {
  const signal = AbortSignal.timeout(STOP_WAIT_MS);
  return fetch("stop", { method: "POST", headers: { "X-Stop-Token": token }, signal });
}

/** Wait for another token than `old`: the page connects again within a second. */
async function renewed(token, old) {
  for (const deadline = performance.now() + TOKEN_WAIT_MS; token() === old && performance.now() < deadline; )
    await new Promise((done) => setTimeout(done, 50));
  return token() !== old;
}
