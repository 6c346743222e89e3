"""Reads and writes PNG files of 8 bits a channel, as the program writes them; joins pictures into one."""
import struct
import zlib

import numpy as np

SIGNATURE = b"\x89PNG\r\n\x1a\n"


def _chunks(data):
    if data[:8] != SIGNATURE:
        raise ValueError("no PNG")
    place = 8
    while place < len(data):
        length, kind = struct.unpack(">I4s", data[place:place + 8])
        yield kind, data[place + 8:place + 8 + length]
        place += 12 + length


def _paeth(left, up, corner):
    estimate = left + up - corner
    a, b, c = abs(estimate - left), abs(estimate - up), abs(estimate - corner)
    return left if a <= b and a <= c else up if b <= c else corner


def read(path):
    """Height × width × 3 bytes."""
    packed = b""
    with open(path, "rb") as file:
        for kind, body in _chunks(file.read()):
            if kind == b"IHDR":
                width, height, depth, color, _, _, interlaced = struct.unpack(">IIBBBBB", body)
                if (depth, color, interlaced) != (8, 2, 0):
                    raise ValueError(f"{path}: not RGB of 8 bits")
            elif kind == b"IDAT":
                packed += body
    raw = zlib.decompress(packed)
    stride = 3 * width
    image = np.zeros((height, stride), np.uint8)
    above = np.zeros(stride, np.uint8)
    for y in range(height):
        start = y * (stride + 1)
        method = raw[start]
        line = np.frombuffer(raw, np.uint8, stride, start + 1)
        if method == 0:
            row = line.copy()
        elif method == 1:
            row = np.add.accumulate(line.reshape(-1, 3), axis=0, dtype=np.uint8).reshape(-1)
        elif method == 2:
            row = line + above
        else:
            row = bytearray(line.tobytes())
            upper = above.tobytes()
            for i in range(stride):
                left = row[i - 3] if i >= 3 else 0
                if method == 3:
                    row[i] = (row[i] + (left + upper[i]) // 2) & 255
                else:
                    row[i] = (row[i] + _paeth(left, upper[i], upper[i - 3] if i >= 3 else 0)) & 255
            row = np.frombuffer(bytes(row), np.uint8)
        image[y] = row
        above = image[y]
    return image.reshape(height, width, 3)


def _chunk(kind, body):
    return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))


def write(path, image):
    height, width, _ = image.shape
    difference = np.diff(image.reshape(height, width * 3).astype(np.int16), axis=0, prepend=0).astype(np.uint8)
    rows = np.concatenate([np.full((height, 1), 2, np.uint8), difference], axis=1)  # every row: filter "up"
    with open(path, "wb") as file:
        file.write(SIGNATURE + _chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)) +
                   _chunk(b"IDAT", zlib.compress(rows.tobytes(), 9)) + _chunk(b"IEND", b""))


def halved(image):
    height, width = image.shape[0] // 2 * 2, image.shape[1] // 2 * 2
    even = image[:height, :width].astype(np.uint16)
    return ((even[0::2, 0::2] + even[1::2, 0::2] + even[0::2, 1::2] + even[1::2, 1::2] + 2) // 4).astype(np.uint8)


def posterised(image, levels=32):
    """Fewer colours, for a smaller file."""
    step = 256 // levels
    return np.minimum(image.astype(np.uint16) // step * step + step // 2, 255).astype(np.uint8) | np.where(
        image >= 256 - step, 255, 0).astype(np.uint8)


def side_by_side(images):
    height = max(image.shape[0] for image in images)
    padded = [np.pad(i, ((0, height - i.shape[0]), (0, 0), (0, 0)), constant_values=255) for i in images]
    return np.concatenate(padded, axis=1)
