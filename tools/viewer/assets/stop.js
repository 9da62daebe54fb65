// The stop button of a live page: a press stops every driver; then it shows what each of them confirms.

const STOP_WAIT_MS = 4000; // longer than the server waits for the drivers
const TOKEN_WAIT_MS = 3000; // longer than a page waits before it connects again

/** `token` gives the server's present token. */
function stopButton(token) {
  const outcome = html("span", { class: "outcome", role: "alert" });
  const button = html("button", { class: "stop", type: "button", text: "STOP", title: "emergency stop of every driver" });
  button.addEventListener("click", async () => {
    outcome.className = "outcome";
    outcome.textContent = "stopping …";
    const [confirmed, words] = await pressed(token);
    outcome.className = confirmed ? "outcome confirmed" : "outcome failed";
    outcome.textContent = words;
  });
  return html("div", { class: "stopping" }, button, outcome);
}

/** Whether every driver has confirmed, and the words for it. A server that was restarted refuses the old token. */
async function pressed(token) {
  const old = token();
  try {
    let response = await post(old);
    if (response.status === 403 && (await renewed(token, old))) response = await post(token());
    if (!response.ok) return [false, `refused (${response.status}); use tailor estop`];
    const { confirmed, drivers } = await response.json();
    const modes = Object.entries(drivers).map(([robot, mode]) => `${robot} is ${mode}`);
    return [confirmed, modes.join(", ") || "no driver is on the bus"];
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
