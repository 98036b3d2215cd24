// What the page shows now, the controls that change it, and the address that keeps it (#frame=12&pick=30,40).

// Seeds have up to 64 bits, more than numbers here.
const page = JSON.parse(document.getElementById("page-data").textContent.replace(/"seed": (\d+)/, '"seed": "$1"'));
const $ = (id) => document.getElementById(id);
const SHOWS = { picture: "picture", difference: "difference from reference", "a-b": "difference A − B", error: "standard error" };
const LAYOUTS = { one: "A alone", flip: "flip A and B", split: "split A | B", side: "side by side" };
const FRAMES_PER_SECOND = 12, FLIP_MILLISECONDS = 700, STRIP_MILLISECONDS = 100, ADDRESS_MILLISECONDS = 300;

const state = { scene: 0, frame: null, show: "picture", layout: "one", split: 0.5, ev: 0, tone: "gamma", limit: 0, flipped: false };
for (const scene of page.scenes) scene.films = scene.films.map((film) => new Film(film));
const view = new View($("stage"), {
  onPick: (patch) => update({ patch }),
  onHover: (x, y) => showReadout({ x0: x, y0: y, x1: x, y1: y }),
  onSplit: (split) => update({ split }),
});

const scene = () => page.scenes[state.scene];
const film = (index) => scene().films[index];
const shown = () => scene().films.filter((_, index) => index === state.a || (state.layout !== "one" && index === state.b));
const frames = () => Math.max(...scene().films.map(({ frames }) => frames));

function choices(select, entries) {
  select.replaceChildren(...entries.map(([value, text]) => new Option(text, value)));
}

/** Ways of showing that the scene has something for. */
function possibleShows() {
  const { films, reference } = scene();
  const possible = { picture: true, difference: reference !== null, "a-b": films.length > 1, error: films.some((f) => f.hasError) };
  return Object.entries(SHOWS).filter(([name]) => possible[name]);
}

/** Unpacks a scene, then sets everything to what suits it. */
async function openScene(index, wanted = {}) {
  $("loading").hidden = false;
  const next = page.scenes[index];
  await Promise.all(next.films.map((each) => each.load()));
  const second = Math.min(1, next.films.length - 1);
  Object.assign(state, { scene: index, a: 0, b: second, layout: "one", show: "picture", tone: next.toneMap });
  const guide = film(next.reference ?? 0), bright = guide.percentile(0.99);
  next.unit ??= guide.mean() || 1;
  state.ev = bright > 0 ? -Math.round(4 * Math.log2(bright)) / 4 : 0;
  state.limit = -1;
  state.frame = Math.min(state.frame ?? guide.brightestFrame(), frames() - 1);
  const { width, height } = guide;
  state.patch = { x0: width >> 1, y0: height >> 1, x1: width >> 1, y1: height >> 1 };
  Object.assign(state, wanted);
  if (!possibleShows().some(([name]) => name === state.show)) state.show = "picture";
  const names = next.films.map(({ name }, i) => [i, name]);
  choices($("a"), names);
  choices($("b"), names);
  choices($("show"), possibleShows());
  choices($("layout"), Object.entries(LAYOUTS));
  choices($("tone"), Object.keys(TONE_CURVES).map((name) => [name, name]));
  for (const id of ["layout-choice", "a-choice", "b-choice"]) $(id).hidden = next.films.length < 2;
  $("time-row").hidden = $("histogram-panel").hidden = frames() < 2;
  $("curves-panel").hidden = !next.curves?.curves.length;
  $("loading").hidden = true;
  makeStrip();
  makeTables();
  update({}, true);
}

/** Changes the state and draws what depends on it. */
function update(change, all = false) {
  const changed = (...names) => all || names.some((name) => name in change);
  Object.assign(state, change);
  if (changed("tone")) state.tones = toneTable(state.tone);
  const current = scene();
  const drawn = { ...state, a: film(state.a), b: film(state.b), reference: film(current.reference), limit: 2 ** state.limit,
                  unit: current.unit, alone: current.films.length < 2 };
  if (changed("show", "layout", "frame", "ev", "tone", "limit", "a", "b")) showStrip(drawn);
  view.draw(drawn);
  showControls();
  if (changed("patch", "a", "b", "layout")) showHistogram();
  else if (changed("frame")) markFrame($("histogram"), state.frame);
  if (changed("patch", "frame")) showPick();
  if (all || "clock" in change) showCurves();
  showReadout(state.patch);
  rememberInAddress();
}

function showControls() {
  for (const name of ["scene", "show", "layout", "a", "b", "tone", "frame", "ev", "limit"]) $(name).value = state[name];
  const { time } = scene(), picture = state.show === "picture";
  $("frame").max = frames() - 1;
  const edge = (frame) => short(time.start + frame * time.width);
  const from = time ? `, time ${edge(state.frame)} to ${edge(state.frame + 1)}${time.unit ? ` ${time.unit}` : ""}` : "";
  $("frame").value = state.frame;
  $("frame-text").value = `frame ${state.frame} of 0–${frames() - 1}${from}`;
  $("ev-text").value = `${state.ev} EV (×${short(2 ** state.ev)})`;
  $("limit-text").value = `${short(100 * 2 ** state.limit)} %`;
  $("exposure-row").hidden = $("tone-row").hidden = !picture;
  $("limit-row").hidden = $("scale").hidden = picture;
  const limit = `${short(100 * 2 ** state.limit)} %`, of = scene().reference === null ? "mean" : "reference's mean";
  $("scale-low").textContent = state.show === "error" ? "0" : `−${limit}`;
  $("scale-high").textContent = `${state.show === "error" ? "" : "+"}${limit} of the ${of}`;
  $("scale-bar").style.background = gradientOf(state.show === "error" ? SEQUENTIAL : DIVERGING);
}

const place = ({ x0, y0, x1, y1 }) =>
  x0 === x1 && y0 === y1 ? `pixel ${x0}, ${y0}` : `patch ${x0}–${x1} × ${y0}–${y1} (${(x1 - x0 + 1) * (y1 - y0 + 1)} pixels)`;
const withError = ({ value, error }) => short(value) + (Number.isNaN(error) ? "" : ` ± ${short(error)}`);

function showReadout(patch) {
  const { width, height } = film(state.a), at = (f) => f.patch(Math.min(state.frame, f.frames - 1), patch);
  const each = shown().map((f) => `${f.name}: ${withError(at(f))}`);
  $("readout").textContent = `${place(patch)} of ${width} × ${height} – ${each.join("; ")}. Click a pixel or drag a patch.`;
}

/** All films' values of the patch, and their differences from the reference. */
function showPick() {
  const { films, reference } = scene();
  const values = films.map((f) => f.patch(Math.min(state.frame, f.frames - 1), state.patch));
  const target = values[reference];
  const header = ["method", "value", "± standard error", ...(target ? ["− reference", "in standard errors of its own"] : [])];
  const rows = films.map(({ name }, index) => {
    const { value, error } = values[index], row = [name, short(value), short(error)];
    if (!target) return row;
    if (index === reference) return [...row, "–", "–"];
    return [...row, short(value - target.value), error > 0 ? ((value - target.value) / error).toFixed(1).replace(/^-0\.0$/, "0.0") : "–"];
  });
  $("pick-title").textContent = `At ${place(state.patch)}${frames() > 1 ? `, frame ${state.frame}` : ""}`;
  $("pick").replaceChildren(makeTable({ title: "", header, rows }).querySelector("table"));
}

function showHistogram() {
  if (frames() < 2) return;
  const films = shown().filter((f) => f.frames > 1);
  drawHistogram($("histogram"), scene(), films, state.patch, state.frame, (frame) => update({ frame }));
}

function showCurves() {
  if (!$("curves-panel").hidden) drawCurves($("curves"), scene().curves, $("clock").value);
}

/** All films small, where there are several: a click makes one A, with Shift B. */
function makeStrip() {
  const { films } = scene();
  $("strip").hidden = films.length < 2;
  $("strip").replaceChildren(...films.map(({ name }, index) => {
    const figure = element("figure", undefined, { title: `${name}: click for A, Shift and click for B` });
    figure.append(element("canvas"), element("figcaption", name));
    figure.addEventListener("click", (event) => update(event.shiftKey ? { b: index } : { a: index }));
    return figure;
  }));
}

/** The marks at once, the pictures when nothing has changed for a moment. */
function showStrip(drawn) {
  clearTimeout(stripTimer);
  if ($("strip").hidden) return;
  const figures = [...$("strip").children];
  figures.forEach((figure, index) => {
    figure.classList.toggle("is-a", index === state.a);
    figure.classList.toggle("is-b", index === state.b && index !== state.a && state.layout !== "one");
  });
  stripTimer = setTimeout(() => figures.forEach((figure, index) =>
    view.thumbnail(scene().films[index], drawn, figure.querySelector("canvas"))), STRIP_MILLISECONDS);
}
let stripTimer = null;

function makeTables() {
  const current = scene();
  const ofMethod = ({ seconds }) => (name) => (current.commands?.[name] ?? []).filter((run) => run.seconds === seconds);
  const ofScene = (name, method) => page.scenes.find((each) => each.name === name)?.commands?.[method] ?? [];
  const sections = [...(current.tables ?? []).map((table) => makeTable(table, ofMethod(table))),
                    ...(page.tables ?? []).map((table) => makeTable(table, ofScene))];
  const about = [makeFacts("Made by", page.facts.map(({ name, value }) => [name, value]))];
  if (page.statistics) about.push(...statisticsTables(page.statistics));
  if (page.notes) about.push(makeNotes("What the figures mean", page.notes));
  about.push(makeNotes("What this page keeps", precisionNote(current.films)));
  const plotted = frames() > 1 || current.curves;
  $("beside").replaceChildren(...(plotted ? [] : about.splice(0, page.statistics ? 2 : 1))); // where plots would be
  $("tables").replaceChildren(...sections, ...about);
}
