// The picture: one film, or two of them flipped, split or side by side, and the patch that is picked in it.

const DIVIDER_REACH = 10; // CSS pixels

class View {
  /** `onPick(patch)` and `onHover(x, y)` get pixels; `onSplit(share)` the divider's place. */
  constructor(stage, { onPick, onHover, onSplit }) {
    this.stage = stage;
    this.canvas = stage.querySelector("canvas");
    this.context = this.canvas.getContext("2d");
    this.divider = stage.querySelector("#divider");
    this.patchMark = stage.querySelector("#patch");
    this.colours = { diverging: colourTable(DIVERGING), sequential: colourTable(SEQUENTIAL) };
    this.images = new Map();
    this.listen(onPick, onHover, onSplit);
  }

  listen(onPick, onHover, onSplit) {
    let start = null, splitting = false;
    this.stage.addEventListener("pointerdown", (event) => {
      if (!this.state) return;
      this.stage.setPointerCapture?.(event.pointerId);
      splitting = this.nearDivider(event);
      start = splitting ? null : this.pixelAt(event);
      event.preventDefault();
    });
    this.stage.addEventListener("pointermove", (event) => {
      if (!this.state) return;
      const at = this.pixelAt(event);
      if (splitting) return onSplit(this.shareAt(event));
      if (start) this.markPatch(patchBetween(start, at));
      else onHover(at.x, at.y);
    });
    this.stage.addEventListener("pointerup", (event) => {
      if (start) onPick(patchBetween(start, this.pixelAt(event)));
      start = null;
      splitting = false;
    });
  }

  shareAt(event) {
    const box = this.canvas.getBoundingClientRect();
    return Math.max(0, Math.min(1, (event.clientX - box.left) / box.width));
  }
  nearDivider(event) {
    const width = this.canvas.getBoundingClientRect().width;
    return this.state.layout === "split" && Math.abs(this.shareAt(event) - this.state.split) * width < DIVIDER_REACH;
  }
  pixelAt(event) {
    const box = this.canvas.getBoundingClientRect(), { width, height } = this.state.a;
    const inside = (value, size) => Math.max(0, Math.min(size - 1, Math.floor(value)));
    const x = inside(((event.clientX - box.left) / box.width) * this.canvas.width, this.canvas.width);
    return { x: x % width, y: inside(((event.clientY - box.top) / box.height) * height, height) };
  }

  /** Largest whole or simple multiple of the picture that fits. */
  resize(state) {
    const wide = state.layout === "side" ? 2 * state.a.width : state.a.width;
    if (this.canvas.width !== wide || this.canvas.height !== state.a.height) {
      this.canvas.width = wide;
      this.canvas.height = state.a.height;
    }
    const room = this.stage.parentElement.clientWidth - 24;
    const high = Math.max(240, Math.min(window.innerHeight - 290, 640));
    const scale = Math.min(room / wide, high / state.a.height);
    this.canvas.style.width = `${Math.floor(wide * scale)}px`;
    this.canvas.style.height = `${Math.floor(state.a.height * scale)}px`;
  }

  /** The picture of a film in the state's way of showing, kept for as long as the film's size stays. */
  paint(film, state) {
    let image = this.images.get(film);
    if (!image) this.images.set(film, (image = new ImageData(film.width, film.height)));
    const out = new Uint32Array(image.data.buffer);
    const frame = Math.min(state.frame, film.frames - 1);
    if (state.show === "picture") paintPicture(film, frame, 2 ** state.ev, state.tones, out);
    else if (state.show === "error") paintError(film, frame, state.limit * state.unit, this.colours.sequential, out);
    else paintDifference(film, state.show === "a-b" ? state.b : state.reference, frame, state.limit * state.unit,
                         this.colours.diverging, out);
    return image;
  }

  draw(state) {
    this.state = state;
    this.resize(state);
    const { context, canvas } = this, { a, b, layout } = state;
    const first = layout === "flip" && state.flipped ? b : a;
    context.putImageData(this.paint(first, state), 0, 0);
    if (layout === "side") context.putImageData(this.paint(b, state), a.width, 0);
    if (layout === "split") {
      const at = Math.round(state.split * a.width);
      context.putImageData(this.paint(b, state), 0, 0, at, 0, a.width - at, a.height);
    }
    this.divider.hidden = layout !== "split" && layout !== "side";
    this.divider.style.left = `${(layout === "side" ? 0.5 : state.split) * canvas.clientWidth}px`;
    this.tags(state, first);
    this.markPatch(state.patch);
  }

  tags(state, first) {
    const both = state.layout === "split" || state.layout === "side";
    const [left, right] = [document.getElementById("tag-a"), document.getElementById("tag-b")];
    left.hidden = state.alone;
    right.hidden = !both;
    left.textContent = first.name;
    right.textContent = state.b?.name ?? "";
  }

  markPatch(patch) {
    this.patchMark.hidden = !patch;
    if (!patch) return;
    const scale = this.canvas.clientWidth / this.canvas.width, style = this.patchMark.style;
    style.left = `${patch.x0 * scale}px`;
    style.top = `${patch.y0 * scale}px`;
    style.width = `${(patch.x1 - patch.x0 + 1) * scale}px`;
    style.height = `${(patch.y1 - patch.y0 + 1) * scale}px`;
  }

  /** A film's picture on a small canvas of its own. */
  thumbnail(film, state, canvas) {
    canvas.width = film.width;
    canvas.height = film.height;
    canvas.getContext("2d").putImageData(this.paint(film, state), 0, 0);
  }
}

function patchBetween(p, q) {
  return { x0: Math.min(p.x, q.x), y0: Math.min(p.y, q.y), x1: Math.max(p.x, q.x), y1: Math.max(p.y, q.y) };
}
