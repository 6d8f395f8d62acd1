"""Pictures by formula for the oracles of metrics: whole numbers from 0 to 255, to be divided by 256, so that
tests/patterns.h makes the very same floats."""


def hash32(x):
    """Wellons' lowbias32, as in core/sampling.h."""
    x = (x ^ (x >> 16)) * 0x7FEB352D & 0xFFFFFFFF
    x = (x ^ (x >> 15)) * 0x846CA68B & 0xFFFFFFFF
    return x ^ (x >> 16)


def pattern(x, y, c):
    """Smooth waves, an edge and a little texture: 0..255."""
    wave = (x * x * (c + 1) // 16 + 3 * y * (c + 2)) % 128
    edge = 96 if (x + 2 * y) % 50 < 25 else 0
    return wave + edge + (hash32(x + 1000 * y) & 31)


def reference(x, y, c):
    return pattern(x, y, c)


def noisy(x, y, c):
    noise = (hash32(7777 + x + 1000 * y + 1000000 * c) & 63) - 32
    return min(255, max(0, pattern(x, y, c) + noise))


def blurred(x, y, c):
    """3x3 box, rounded down, of the pattern; it is defined beyond the picture's edges except for negative numbers."""
    return sum(pattern(max(0, x + i), max(0, y + j), c) for i in (-1, 0, 1) for j in (-1, 0, 1)) // 9


def shifted(x, y, c):
    return pattern(x + 1, y + 2, c)
