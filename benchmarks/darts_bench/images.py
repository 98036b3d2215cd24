"""Reading the renderer's images (EXR with its stderr layer, PFM) and bringing them to a common resolution and tone."""

import struct
import zlib
from pathlib import Path

import numpy as np

from darts_bench.run import BenchError


class ImageError(BenchError):
    """An image that cannot be used; the message names the file."""


EXR_MAGIC = 20000630
EXR_TILED_DEEP_OR_MULTIPART = 0x200 | 0x800 | 0x1000
EXR_TYPES = {0: np.dtype("<u4"), 1: np.dtype("<f2"), 2: np.dtype("<f4")}
EXR_LINES_PER_CHUNK = {0: 1, 2: 1, 3: 16}  # uncompressed, ZIPS, ZIP


def read_pfm(path):
    """A PFM image as float64, (height, width, 3), row 0 at the top."""
    data = Path(path).read_bytes()
    fields = data.split(None, 4)
    if len(fields) < 4 or fields[0] not in (b"PF", b"Pf"):
        raise ImageError(f"{path}: not a PFM image")
    width, height, scale = int(fields[1]), int(fields[2]), float(fields[3])
    channels = 3 if fields[0] == b"PF" else 1
    size = width * height * channels * 4
    header = data.index(fields[3], data.index(fields[2], data.index(fields[1]) + len(fields[1])) + len(fields[2]))
    start = header + len(fields[3]) + 1  # exactly one white-space character follows the scale
    if len(data) < start + size:
        raise ImageError(f"{path}: the PFM image is truncated")
    pixels = np.frombuffer(data, "<f4" if scale < 0 else ">f4", width * height * channels, start)
    image = pixels.reshape(height, width, channels)[::-1].astype(np.float64)
    return np.repeat(image, 3, axis=2) if channels == 1 else image


def write_pfm(path, image):
    """An image (height, width, 3), row 0 at the top, as a PFM of 32-bit floats."""
    header = f"PF\n{image.shape[1]} {image.shape[0]}\n-1.0\n".encode()
    Path(path).write_bytes(header + image[::-1].astype("<f4").tobytes())


def _exr_header(data, path):
    if len(data) < 8 or struct.unpack_from("<i", data)[0] != EXR_MAGIC:
        raise ImageError(f"{path}: not an EXR image")
    if struct.unpack_from("<I", data, 4)[0] & EXR_TILED_DEEP_OR_MULTIPART:
        raise ImageError(f"{path}: tiled, deep and multi-part EXR files (sequences of frames) are not compared here")
    attributes, at = {}, 8
    while data[at] != 0:
        name_end = data.index(0, at)
        type_end = data.index(0, name_end + 1)
        size = struct.unpack_from("<i", data, type_end + 1)[0]
        attributes[data[at:name_end].decode()] = data[type_end + 5:type_end + 5 + size]
        at = type_end + 5 + size
    return attributes, at + 1


def _exr_channels(chlist):
    channels, at = [], 0
    while chlist[at] != 0:
        end = chlist.index(0, at)
        channels.append((chlist[at:end].decode(), EXR_TYPES[struct.unpack_from("<i", chlist, end + 1)[0]]))
        at = end + 17
    return channels


def _unzip(chunk, size):
    """Undoes EXR's ZIP: deflate, differences of neighbouring bytes, even and odd bytes apart."""
    if len(chunk) == size:  # stored as it is where compression did not help
        return chunk
    differences = np.frombuffer(zlib.decompress(chunk), np.uint8).astype(np.int64)
    differences[1:] -= 128
    split = (np.cumsum(differences) & 255).astype(np.uint8)
    joined = np.empty_like(split)
    half = (len(split) + 1) // 2
    joined[0::2], joined[1::2] = split[:half], split[half:]
    return joined.tobytes()


def read_exr(path):
    """All layers of a single-part scan-line EXR image: {"": colour, "stderr": ...}, each float64 (height, width, 3)."""
    data = Path(path).read_bytes()
    try:
        attributes, at = _exr_header(data, path)
        channels = _exr_channels(attributes["channels"])
        left, top, right, bottom = struct.unpack("<4i", attributes["dataWindow"])
        lines = EXR_LINES_PER_CHUNK.get(attributes["compression"][0])
        if lines is None:
            raise ImageError(f"{path}: EXR compression {attributes['compression'][0]} is not supported; use ZIP or none")
        width, height = right - left + 1, bottom - top + 1
        planes = {name: np.empty((height, width)) for name, _ in channels}
        row_bytes = width * sum(kind.itemsize for _, kind in channels)
        for chunk in range((height + lines - 1) // lines):
            offset = struct.unpack_from("<Q", data, at + 8 * chunk)[0]
            y, size = struct.unpack_from("<2i", data, offset)
            rows = range(y - top, min(y - top + lines, height))
            pixels = _unzip(data[offset + 8:offset + 8 + size], row_bytes * len(rows))
            position = 0
            for row in rows:
                for name, kind in channels:
                    planes[name][row] = np.frombuffer(pixels, kind, width, position)
                    position += width * kind.itemsize
    except (struct.error, ValueError, IndexError, KeyError, zlib.error) as error:
        raise ImageError(f"{path}: damaged EXR image ({error})") from error
    layers = {name.rpartition(".")[0] for name in planes}
    return {layer: np.stack([planes[f"{layer}.{c}" if layer else c] for c in "RGB"], axis=-1) for layer in layers}


def _overlaps(fine, coarse):
    """Weights (coarse, fine) of the part that each of `fine` equal intervals has in each of `coarse` ones."""
    low = np.arange(coarse)[:, None] / coarse
    fine_low = np.arange(fine)[None, :] / fine
    overlap = np.minimum(low + 1 / coarse, fine_low + 1 / fine) - np.maximum(low, fine_low)
    return np.clip(overlap, 0.0, None) * coarse


def average_down(image, shape):
    """Mean over each pixel of the coarser grid `shape` (height, width), weighted by area: 3x3 means for a third."""
    height, width = image.shape[:2]
    if (height, width) == tuple(shape):
        return image
    if height < shape[0] or width < shape[1]:
        raise ImageError(f"an image of {width}x{height} pixels cannot be averaged down to {shape[1]}x{shape[0]}")
    rows, columns = _overlaps(height, shape[0]), _overlaps(width, shape[1])
    return np.einsum("ah,hw...,bw->ab...", rows, image, columns, optimize=True)


def tone_map(image, white):
    """sRGB values in [0, 1] of a linear image whose value `white` is to be white."""
    linear = np.clip(image / white, 0.0, 1.0)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
