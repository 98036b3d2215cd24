// From values to bytes of the screen. The tone curves are the renderer's (docs/scene-format.md, section 3.2).

const TONE_CURVES = {
  linear: (c) => c,
  gamma: (c) => c ** (1 / 2.2),
  reinhard: (c) => (c / (1 + c)) ** (1 / 2.2),
  filmic: (c) => {
    const x = Math.max(0, c - 0.004);
    return (x * (6.2 * x + 0.5)) / (x * (6.2 * x + 1.7) + 0.06);
  },
  pbrt: (c) => (c <= 0.0031308 ? 12.92 * c : 1.055 * c ** (1 / 2.4) - 0.055),
};
const TONE_STEPS = 65536;

/** Bytes of a curve by c / (1 + c) in TONE_STEPS steps, so that all of [0, infinity) has a place. */
function toneTable(name) {
  const table = new Uint8Array(TONE_STEPS);
  for (let i = 0; i < TONE_STEPS; ++i) {
    const c = i / (TONE_STEPS - i);
    table[i] = Math.min(255, Math.floor(255 * Math.max(0, TONE_CURVES[name](c))));
  }
  return table;
}

/** Colours at evenly spaced places from the low to the high end of a scale. */
const DIVERGING = [[5, 48, 97], [67, 147, 195], [247, 247, 247], [214, 96, 77], [103, 0, 31]];
const SEQUENTIAL = [[8, 6, 28], [93, 22, 110], [202, 62, 72], [248, 150, 40], [252, 252, 180]];

/** 256 colours of a scale as RGBA words. */
function colourTable(stops) {
  const table = new Uint32Array(256);
  for (let i = 0; i < 256; ++i) {
    const at = (i / 255) * (stops.length - 1);
    const left = Math.min(Math.floor(at), stops.length - 2);
    const [r, g, b] = stops[left].map((c, k) => Math.round(c + (stops[left + 1][k] - c) * (at - left)));
    table[i] = (255 << 24) | (b << 16) | (g << 8) | r;
  }
  return table;
}

function gradientOf(stops) {
  return `linear-gradient(90deg, ${stops.map((c) => `rgb(${c})`).join(", ")})`;
}

/** Tone-mapped colours of a frame into RGBA words. */
function paintPicture(film, frame, exposure, tones, out) {
  const base = frame * film.pixels;
  for (let y = 0, i = 0; y < film.height; ++y) {
    for (let x = 0; x < film.width; ++x, ++i) {
      const block = film.blockAt(frame, x, y);
      const sum = (3 * exposure * film.table[film.codes[base + i]]) / 255;
      const red = film.red[block], green = film.green[block];
      const r = sum * red, g = sum * green, b = sum * Math.max(0, 255 - red - green);
      out[i] = (255 << 24) | (tones[(TONE_STEPS * b) / (1 + b) | 0] << 16)
        | (tones[(TONE_STEPS * g) / (1 + g) | 0] << 8) | tones[(TONE_STEPS * r) / (1 + r) | 0];
    }
  }
}

/** Differences from another film's frame; `limit` is at the scale's ends. */
function paintDifference(film, other, frame, limit, colours, out) {
  const base = frame * film.pixels, otherBase = Math.min(frame, other.frames - 1) * other.pixels;
  for (let i = 0; i < film.pixels; ++i) {
    const difference = film.table[film.codes[base + i]] - other.table[other.codes[otherBase + i]];
    out[i] = colours[Math.max(0, Math.min(255, Math.round(127.5 * (1 + difference / limit))))];
  }
}

function paintError(film, frame, limit, colours, out) {
  for (let y = 0, i = 0; y < film.height; ++y)
    for (let x = 0; x < film.width; ++x, ++i)
      out[i] = colours[Math.min(255, Math.round((255 * film.error(frame, x, y)) / limit) || 0)];
}
