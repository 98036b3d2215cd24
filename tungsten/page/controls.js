// Listening to the controls, playing, and the address of what is shown.

/** Once nothing has changed for a moment: browsers refuse more than about ten changes a second. */
function rememberInAddress() {
  clearTimeout(addressTimer);
  addressTimer = setTimeout(() => history.replaceState(null, "", address()), ADDRESS_MILLISECONDS);
}
let addressTimer = null;

function address() {
  const { patch } = state, kept = ["scene", "frame", "show", "layout", "a", "b", "ev", "tone", "limit"];
  const parts = kept.map((name) => `${name}=${state[name]}`);
  return `#${parts.join("&")}&pick=${[patch.x0, patch.y0, patch.x1, patch.y1]}`;
}

/** What the address asks for; numbers that make no sense are left out. */
function wantedByAddress() {
  const wanted = {}, given = new URLSearchParams(location.hash.slice(1));
  const index = Math.min(page.scenes.length - 1, Math.max(0, parseInt(given.get("scene")) || 0)), { films } = page.scenes[index];
  const take = (name, low, high) => {
    const value = Number(given.get(name));
    if (given.has(name) && value >= low && value <= high) wanted[name] = value;
  };
  take("frame", 0, Math.max(...films.map(({ frames }) => frames)) - 1);
  for (const name of ["a", "b"]) take(name, 0, films.length - 1);
  take("ev", -64, 64);
  take("limit", -10, 4);
  for (const [name, known] of [["show", SHOWS], ["layout", films.length > 1 ? LAYOUTS : {}], ["tone", TONE_CURVES]])
    if (given.get(name) in known) wanted[name] = given.get(name);
  const [x0, y0, x1 = x0, y1 = y0] = (given.get("pick") ?? "").split(",").map(Number);
  if (x0 >= 0 && y0 >= 0 && x1 >= x0 && y1 >= y0 && x1 < films[0].width && y1 < films[0].height) wanted.patch = { x0, y0, x1, y1 };
  return [index, wanted];
}

function listen() {
  const follow = (type, names, read) => {
    for (const name of names) $(name).addEventListener(type, () => update({ [name]: read($(name).value) }));
  };
  follow("change", ["show", "layout", "tone", "clock"], String);
  follow("change", ["a", "b"], Number);
  follow("input", ["frame", "ev", "limit"], Number);
  $("scene").addEventListener("change", () => openScene(Number($("scene").value)).catch(fail));
  $("play").addEventListener("click", () => setPlaying(!playing));
  $("commands").addEventListener("click", ({ target }) => target === $("commands") && $("commands").close());
  document.addEventListener("keydown", onKey);
  const redraw = () => update({}, true);
  window.addEventListener("resize", redraw);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
  setInterval(() => state.layout === "flip" && update({ flipped: !state.flipped }), FLIP_MILLISECONDS);
}

/** Arrows and space are left to a control that has them itself. */
function onKey(event) {
  if (/^(INPUT|SELECT|BUTTON)$/.test(event.target.tagName) || frames() < 2) return;
  const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
  if (event.key === " ") setPlaying(!playing);
  else if (step) update({ frame: (state.frame + step + frames()) % frames() });
  else return;
  event.preventDefault();
}

let playing = null;
function setPlaying(on) {
  clearInterval(playing);
  playing = on ? setInterval(() => update({ frame: (state.frame + 1) % frames() }), 1000 / FRAMES_PER_SECOND) : null;
  $("play").textContent = on ? "❚❚" : "▶";
}

function open() {
  document.title = $("title").textContent = page.title;
  $("subtitle").textContent = page.subtitle;
  choices($("scene"), page.scenes.map(({ name }, index) => [index, name]));
  $("scene-choice").hidden = page.scenes.length < 2;
  const canUnpack = "DecompressionStream" in window;
  if (!canUnpack) throw new Error("this browser cannot unpack the page's images; Chrome 80, Firefox 113 and Safari 16.4 can");
  listen();
  return openScene(...wantedByAddress());
}

function fail(error) {
  $("loading").textContent = `This page cannot be shown: ${error.message}`;
  throw error;
}

/** Resolves when the first scene is shown. */
const ready = Promise.resolve().then(open).catch(fail);
