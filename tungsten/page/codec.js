// Films as the page keeps them (tungsten/io/FilmCode.h says how): base64 of deflated planes of bytes.

async function unpack(base64) {
  const text = atob(base64.trim());
  const packed = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) packed[i] = text.charCodeAt(i);
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** Undoes differences of neighbours, modulo 256, in place. */
function accumulate(bytes) {
  for (let i = 1; i < bytes.length; ++i) bytes[i] += bytes[i - 1];
  return bytes;
}

/** Values of codes: code 0 is 0, the highest one is 2^top, and each step below it 2^-step times that. */
function codeTable(codes, top, step) {
  const table = new Float32Array(codes);
  for (let code = 1; code < codes; ++code) table[code] = 2 ** (top - (codes - 1 - code) * step);
  return table;
}

/** One render: the mean of the channels of every pixel and frame, colours, and standard errors of that mean. */
class Film {
  constructor(description) {
    Object.assign(this, description);
    this.pixels = this.width * this.height;
    this.table = codeTable(65536, this.top, this.step);
    this.errorTable = codeTable(256, this.errorTop, this.errorStep);
  }

  /** Unpacks once, and frees the text. */
  load() {
    if (!this.loading) {
      const element = document.getElementById(this.data);
      this.loading = unpack(element.textContent).then((bytes) => this.split(bytes));
      this.loading.then(() => element.remove());
    }
    return this.loading;
  }

  split(bytes) {
    const samples = this.pixels * this.frames;
    this.blocksWide = Math.ceil(this.width / this.block);
    const blocks = this.blocksWide * Math.ceil(this.height / this.block);
    this.blocks = blocks;
    const coarse = blocks * this.frames;
    this.codes = new Uint16Array(samples);
    for (let i = 0, code = 0; i < samples; ++i) {
      const zigzag = bytes[i] | (bytes[samples + i] << 8);
      code = (code + ((zigzag >>> 1) ^ -(zigzag & 1))) & 0xffff;
      this.codes[i] = code;
    }
    const plane = (index) => accumulate(bytes.slice(2 * samples + index * coarse, 2 * samples + (index + 1) * coarse));
    this.red = plane(0);
    this.green = plane(1);
    this.errors = this.hasError ? plane(2) : null;
  }

  blockAt(frame, x, y) {
    return frame * this.blocks + Math.floor(y / this.block) * this.blocksWide + Math.floor(x / this.block);
  }
  value(frame, x, y) {
    return this.table[this.codes[frame * this.pixels + y * this.width + x]];
  }
  /** Standard error, NaN where it is unknown. */
  error(frame, x, y) {
    return this.errors ? this.errorTable[this.errors[this.blockAt(frame, x, y)]] : NaN;
  }

  /** Mean over a patch, and the mean of its pixels' standard errors: the most that the mean's own can be. */
  patch(frame, { x0, y0, x1, y1 }) {
    let value = 0, error = 0;
    for (let y = y0; y <= y1; ++y)
      for (let x = x0; x <= x1; ++x) {
        value += this.value(frame, x, y);
        error += this.error(frame, x, y);
      }
    const count = (x1 - x0 + 1) * (y1 - y0 + 1);
    return { value: value / count, error: error / count };
  }

  /** Value that a share of all samples does not exceed. */
  percentile(share) {
    const counts = new Uint32Array(65536);
    for (const code of this.codes) ++counts[code];
    for (let code = 65535, above = 0; code > 0; --code) {
      above += counts[code];
      if (above > (1 - share) * this.codes.length) return this.table[code];
    }
    return 0;
  }

  /** The frame of most light. */
  brightestFrame() {
    const sums = new Float64Array(this.frames), size = this.codes.length / this.frames;
    this.codes.forEach((code, i) => (sums[Math.floor(i / size)] += this.table[code]));
    return sums.indexOf(Math.max(...sums));
  }

  /** Mean over all pixels and frames. */
  mean() {
    let sum = 0;
    for (const code of this.codes) sum += this.table[code];
    return sum / this.codes.length;
  }
}
