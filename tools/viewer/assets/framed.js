// The page as a frame among others: it reports its run to the page around it, which has the player.

function framed(run, player) {
  const first = run.actions()[0]?.begin ?? run.start;
  const send = (message) => parent.postMessage(message, "*");
  const relative = (at) => at - first;
  document.documentElement.classList.add("framed");
  player.go = (at) => send({ go: relative(at) });
  player.key = (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || isPress(event)) return;
    if ([" ", "Home", "End"].includes(event.key) || event.key.startsWith("Arrow")) event.preventDefault();
    send({ key: { key: event.key, shiftKey: event.shiftKey } });
  };
  addEventListener("message", ({ source, data }) => {
    if (source === parent && data.at !== undefined) player.set(data.at + first);
  });
  player.set(first);
  new ResizeObserver(() => send({ height: document.body.scrollHeight })).observe(document.body);
  send({
    report: { start: relative(run.start), end: relative(run.end), landmarks: run.landmarks().map(relative) },
  });
}
