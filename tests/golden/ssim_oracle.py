"""Makes ssim.json with scikit-image, the oracle of core/ssim.cpp. Needs numpy and scikit-image (made with 0.19.3).

    python3 tests/golden/ssim_oracle.py > tests/golden/ssim.json

The pictures are those of patterns.py, so that tests/metrics_test.cpp makes the very same floats and only numbers need
be kept. Luminance is Rec. 709's, of display-encoded values.
"""
import json

import numpy
import skimage
from skimage.metrics import structural_similarity

from patterns import blurred, noisy, reference, shifted

WIDTH, HEIGHT = 61, 47


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
