"""Makes ssim.json with scikit-image, the oracle of core/ssim.cpp. Needs numpy and scikit-image (made with 0.19.3).

    python3 tests/golden/ssim_oracle.py > tests/golden/ssim.json

The pictures are integer formulas divided by 256, so that tests/metrics_test.cpp makes the very same floats and only
numbers need be kept. Luminance is Rec. 709's, of display-encoded values.
"""
import json

import numpy
import skimage
from skimage.metrics import structural_similarity

WIDTH, HEIGHT = 61, 47


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


def luminance(f):
    weights = (0.2126, 0.7152, 0.0722)
    return numpy.array(
        [[sum(w * f(x, y, c) / 256 for c, w in enumerate(weights)) for x in range(WIDTH)] for y in range(HEIGHT)]
    )


truth = luminance(reference)
values = {
    f.__name__: structural_similarity(
        luminance(f), truth, gaussian_weights=True, sigma=1.5, use_sample_covariance=False, data_range=1.0
    )
    for f in (noisy, blurred, shifted)
}
print(json.dumps({"oracle": "scikit-image " + skimage.__version__, "width": WIDTH, "height": HEIGHT, "ssim": values}, indent=2))
