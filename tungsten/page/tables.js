// Tables that sort, the commands behind their rows, and notes.

function element(tag, text, attributes = {}) {
  const made = document.createElement(tag);
  if (text !== undefined) made.textContent = text;
  Object.assign(made, attributes);
  return made;
}

/** The first number in a cell's text, for sorting: "< 0.02", "9.4×", "0.31 (0.30–0.33)". None: NaN. */
function numberIn(text) {
  return parseFloat(String(text).replace(/^[<±\s]+/, "").replace("−", "-"));
}

function compareCells(p, q) {
  const [a, b] = [numberIn(p), numberIn(q)];
  if (Number.isNaN(a) && Number.isNaN(b)) return p.localeCompare(q);
  return Number.isNaN(a) ? 1 : Number.isNaN(b) ? -1 : a - b;
}

/** Sorts by a column: ascending first, then the other way; what is no number stays last. */
function sortBy(table, column) {
  const head = table.tHead.rows[0].cells[column];
  const ascending = head.getAttribute("aria-sort") !== "ascending";
  for (const cell of table.tHead.rows[0].cells) cell.removeAttribute("aria-sort");
  head.setAttribute("aria-sort", ascending ? "ascending" : "descending");
  const text = (row) => row.cells[column].textContent;
  const rows = [...table.tBodies[0].rows].sort((p, q) => {
    const order = compareCells(text(p), text(q));
    const blank = column > 0 && (Number.isNaN(numberIn(text(p))) || Number.isNaN(numberIn(text(q))));
    return ascending || blank ? order : -order;
  });
  table.tBodies[0].append(...rows);
}

function showCommands(title, commands) {
  const list = document.getElementById("command-list");
  list.replaceChildren(element("h2", title));
  for (const { label, command } of commands) list.append(element("h3", label), element("pre", command));
  document.getElementById("commands").showModal();
}

/** A table {title, header, rows: [[text, ...], ...]}; `commandsOf(row's name, column's)` gives what made a cell. */
function makeTable({ title, header, rows }, commandsOf) {
  const table = element("table"), head = table.createTHead().insertRow(), body = table.createTBody();
  header.forEach((name, column) => {
    const cell = element("th", undefined, { scope: "col" }), button = element("button", name, { title: "Sort" });
    button.addEventListener("click", () => sortBy(table, column));
    cell.append(button);
    head.append(cell);
  });
  for (const cells of rows) {
    const row = body.insertRow();
    cells.forEach((text, column) => {
      const cell = row.insertCell(), commands = commandsOf?.(cells[0], header[column]) ?? [];
      cell.textContent = text;
      cell.classList.toggle("long", text.length > 40);
      if (!commands.length) return;
      cell.classList.add("has-commands");
      cell.title = "The commands behind this";
      cell.addEventListener("click", () => showCommands(`${cells[0]}, ${header[column]}: ${text}`, commands));
    });
  }
  const section = element("section");
  section.append(element("h2", title), table);
  return section;
}

/** Names and values, without sorting. */
function makeFacts(title, facts) {
  const table = element("table", undefined, { className: "text" }), body = table.createTBody();
  for (const [name, value] of facts) {
    const row = body.insertRow();
    row.insertCell().textContent = name;
    row.insertCell().append(name === "command" ? element("pre", value) : value);
  }
  const section = element("section");
  section.append(element("h2", title), table);
  return section;
}

/** Paragraphs and lists of a few lines of Markdown. */
function makeNotes(title, text) {
  const section = element("section");
  section.append(element("h2", title));
  for (const block of text.trim().split(/\n(?=- )|\n\n+/)) {
    const paragraph = element("p", undefined, { className: "notes" });
    const parts = block.replace(/^- /, "• ").replaceAll("`", "").split("**");
    parts.forEach((part, i) => paragraph.append(i % 2 ? element("b", part) : part));
    section.append(paragraph);
  }
  return section;
}

/** The tables of a render's statistics (--stats). */
function statisticsTables(statistics) {
  const facts = Object.entries(statistics).filter(([, value]) => typeof value !== "object" || value === null);
  const seconds = (value) => value.toFixed(3);
  const stages = Object.entries(statistics.stages ?? {}).map(
    ([name, stage]) => [name, seconds(stage["wall seconds"]), seconds(stage["CPU seconds"]), String(stage.runs)]);
  const counters = Object.entries(statistics.counters ?? {}).map(([name, count]) => [name, String(count)]);
  const figure = (value) => (value === null ? "unknown" : typeof value === "number" ? String(Number.isInteger(value) ? value : +value.toPrecision(6)) : value);
  const made = [makeFacts("Figures", facts.map(([name, value]) => [name, figure(value)]))];
  if (stages.length) made.push(makeTable({ title: "Stages", header: ["stage", "wall s", "CPU s", "runs"], rows: stages }));
  if (counters.length) made.push(makeTable({ title: "Counters", header: ["counter", "count"], rows: counters }));
  return made;
}

/** How exact the numbers of the page are. */
function precisionNote(films) {
  const half = (step) => `${short(100 * (2 ** (step / 2) - 1))} %`;
  const steps = films.map((film) => film.step), block = Math.max(...films.map((film) => film.block));
  const blocks = block > 1 ? `by blocks of ${block} × ${block} pixels` : "by pixel";
  return `The mean of R, G and B of every pixel and frame to within ${half(Math.max(...steps))} of it; the shares of the colours`
    + ` ${blocks} to within 0.2 % of R + G + B; standard errors of that mean ${blocks} to within`
    + ` ${half(films[0].errorStep)}` + " of them. A patch's standard error is the mean of its pixels': exact where they vary together, as in pictures of photons,"
    + " otherwise an upper bound. Write an EXR or NPY for all digits.";
}
