"""Images as pages keep them: the Python side of tungsten/io/FilmCode.h, which says how, for single images."""

import base64
import zlib

import numpy as np

FINEST_STEP, COARSEST_STEP, ERROR_STEP = 1 / 1024, 1 / 2, 1 / 8  # octaves
LARGEST_BLOCK, SHARE_OF_BLOCKS = 8, 1 / 3


def _logarithms(values):
    with np.errstate(divide="ignore"):
        return np.log2(np.clip(np.nan_to_num(values, posinf=0.0), 0.0, None)).ravel()


def _highest(logs):
    top = float(logs.max())
    return top if np.isfinite(top) else 0.0


def _codes(logs, top, step, last):
    steps = np.where(np.isfinite(logs), np.rint((top - logs) / step), last)
    return np.clip(last - steps, 0, last).astype(np.int64)


def _differences(codes):
    return np.diff(codes, prepend=0)


def _value_planes(logs, top, step):
    """Low bytes, then high bytes, of the zigzag differences."""
    differences = (_differences(_codes(logs, top, step, 65535)) & 0xFFFF).astype(np.uint16).view(np.int16).astype(np.int64)
    zigzag = ((differences << 1) ^ (differences >> 15)) & 0xFFFF
    return (zigzag & 255).astype(np.uint8), (zigzag >> 8).astype(np.uint8)


def _entropy_bytes(plane):
    counts = np.bincount(plane, minlength=256)
    counts = counts[counts > 0]
    return float(-(counts * np.log2(counts / plane.size)).sum() / 8)


def _block_means(plane, block):
    """Means of blocks, smaller ones at the right and lower edges."""
    height, width = plane.shape
    rows, columns = np.arange(0, height, block), np.arange(0, width, block)
    sums = np.add.reduceat(np.add.reduceat(plane, rows, axis=0), columns, axis=1)
    return sums / np.outer(np.diff(np.append(rows, height)), np.diff(np.append(columns, width)))


def _byte_plane(codes):
    return (_differences(codes.ravel()) & 255).astype(np.uint8)


def _block_planes(image, error, block):
    """Shares of red and of green, and standard errors; and the top of their scale."""
    positive = np.clip(np.nan_to_num(image, posinf=0.0), 0.0, None)
    sums = [_block_means(positive[..., c], block) for c in range(3)]
    total = np.sum(sums, axis=0)
    shares = [np.where(total > 0, s / np.where(total > 0, total, 1), 1 / 3) for s in sums[:2]]
    planes = [_byte_plane(np.rint(255 * share).astype(np.int64)) for share in shares]
    if error is None:
        return planes, 0.0
    logs = _logarithms(np.sqrt(_block_means(np.nan_to_num(error.mean(axis=-1)) ** 2, block)))
    top = _highest(logs)
    return [*planes, _byte_plane(_codes(logs, top, ERROR_STEP, 255))], top


def _size(planes):
    return sum(_entropy_bytes(plane) for plane in planes)


def encode(name, identity, image, error=None, budget_bytes=20e6):
    """What the page's data says of an image (height, width, 3), and its payload as text."""
    block, step = 1, FINEST_STEP
    blocks, error_top = _block_planes(image, error, block)
    while _size(blocks) > SHARE_OF_BLOCKS * budget_bytes and block < LARGEST_BLOCK:
        block *= 2
        blocks, error_top = _block_planes(image, error, block)
    logs = _logarithms(image.mean(axis=-1))
    top, left = _highest(logs), budget_bytes - _size(blocks)
    values = _value_planes(logs, top, step)
    while _size(values) > left and step < COARSEST_STEP:
        step *= 2
        values = _value_planes(logs, top, step)
    payload = zlib.compress(b"".join(plane.tobytes() for plane in [*values, *blocks]))
    description = {"name": name, "width": image.shape[1], "height": image.shape[0], "frames": 1, "block": block, "step": step,
                   "top": top, "errorStep": ERROR_STEP, "errorTop": error_top, "hasError": int(error is not None), "data": identity}
    return description, base64.b64encode(payload).decode()
