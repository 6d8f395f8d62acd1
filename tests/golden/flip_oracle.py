"""Makes flip.json with the authors' own program, the oracle of core/flip.cpp and core/flip_hdr.cpp. Needs numpy and
flip-evaluator (made with 1.7).

    python3 tests/golden/flip_oracle.py > tests/golden/flip.json

The pictures are those of patterns.py, and for HDR-FLIP the fourth power of them times 50, so
that tests/flip_test.cpp makes the very same floats and only numbers need be kept: the mean of the map and some of its
pixels.
"""
import importlib.metadata
import json

import flip_evaluator
import numpy

from patterns import blurred, noisy, reference, shifted

WIDTH, HEIGHT = 61, 47
PLACES = [(0, 0), (30, 20), (60, 46), (5, 40), (47, 3)]


def picture(f):
    return numpy.array(
        [[[f(x, y, c) for c in range(3)] for x in range(WIDTH)] for y in range(HEIGHT)], dtype=numpy.float32
    ) / numpy.float32(256)


def radiance(f):
    p = picture(f)
    return p * p * p * p * numpy.float32(50)


def score(reference, image, kind, parameters={}):
    error_map, mean, used = flip_evaluator.evaluate(
        reference, image, kind, applyMagma=False, parameters=dict(parameters)
    )
    result = {"mean": float(numpy.mean(error_map, dtype=numpy.float64)),
              "map": [float(error_map[y, x, 0]) for x, y in PLACES]}
    if kind == "HDR":
        result.update(start=used["startExposure"], stop=used["stopExposure"], count=used["numExposures"])
    return result


pairs = (noisy, blurred, shifted)
print(json.dumps({
    "oracle": "flip-evaluator " + importlib.metadata.version("flip-evaluator"),
    "width": WIDTH, "height": HEIGHT, "places": PLACES,
    "ldr": {f.__name__: score(picture(reference), picture(f), "LDR") for f in pairs},
    "ldr_30_pixels_a_degree": {"noisy": score(picture(reference), picture(noisy), "LDR", {"ppd": 30.0})},
    "hdr": {f.__name__: score(radiance(reference), radiance(f), "HDR") for f in pairs},
}, indent=1))
