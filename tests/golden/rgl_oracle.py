"""Makes rgl_mitsuba.json with Mitsuba 3's plugin `measured`, the oracle of materials/rgl.cpp. Needs numpy and mitsuba (made
with 3.9.1), and the eleven files of the RGL database (CC0) that the project's data folder holds:

    python3 tests/golden/rgl_oracle.py $ZONAL_DATA/materials/rgl > tests/golden/rgl_mitsuba.json

The plugin wants spectra: it gets a copy of each file whose three colours stand as three wavelengths, and is asked for
exactly these, so that it interpolates nothing between them. Its values contain the cosine of wo; it indexes by wi. Its
density knows no share of cosine-weighted directions. Negative values stay as they are.
"""
import json
import math
import os
import random
import struct
import sys
import tempfile

import mitsuba
import numpy

mitsuba.set_variant("scalar_spectral")
WAVELENGTHS = [400.0, 500.0, 600.0]
TYPES = {1: "<u1", 5: "<u4", 10: "<f4"}
CODES = {"|u1": 1, "<u1": 1, "<f4": 10}


def read_tensors(path):
    data = open(path, "rb").read()
    (count,) = struct.unpack_from("<I", data, 14)
    at, fields = 18, {}
    for _ in range(count):
        (length,) = struct.unpack_from("<H", data, at)
        name = data[at + 2 : at + 2 + length].decode()
        at += 2 + length
        dimensions, kind, offset = struct.unpack_from("<HBQ", data, at)
        shape = struct.unpack_from(f"<{dimensions}Q", data, at + 11)
        at += 11 + 8 * dimensions
        fields[name] = numpy.frombuffer(data, TYPES[kind], math.prod(shape), offset).reshape(shape)
    return fields


def write_tensors(path, fields):
    pad = lambda b: b + b"\0" * (-len(b) % 8)
    size = 18 + sum(13 + len(name) + 8 * a.ndim for name, a in fields.items())
    header, body = b"tensor_file\0\1\0" + struct.pack("<I", len(fields)), b""
    start = size + -size % 8
    for name, a in fields.items():
        header += struct.pack("<H", len(name)) + name.encode()
        header += struct.pack("<HBQ", a.ndim, CODES[a.dtype.str], start + len(body))
        header += struct.pack(f"<{a.ndim}Q", *a.shape)
        body += pad(a.tobytes())
    open(path, "wb").write(pad(header) + body)


def load(path):
    fields = read_tensors(path)
    fields["spectra"] = fields.pop("rgb")
    fields["wavelengths"] = numpy.array(WAVELENGTHS, "<f4")
    for unused in ("version", "valid"):
        fields.pop(unused, None)
    with tempfile.TemporaryDirectory() as folder:
        copy = os.path.join(folder, "spectral.bsdf")
        write_tensors(copy, fields)
        return mitsuba.load_dict({"type": "measured", "filename": copy})


def direction(theta, phi):
    # Rounded to float here, so that both programs start from the same numbers.
    v = numpy.float32([math.sin(theta) * math.cos(phi), math.sin(theta) * math.sin(phi), math.cos(theta)])
    return [float(x) for x in v]


def interaction(wi):
    si = mitsuba.SurfaceInteraction3f()
    si.wi = mitsuba.Vector3f(*wi)
    si.wavelengths = WAVELENGTHS + WAVELENGTHS[-1:]
    return si


def digits(x):
    return float(f"{x:.9g}")


rng = random.Random(4)
context = mitsuba.BSDFContext()
values, samples = [], []
for name in sorted(os.listdir(sys.argv[1])):
    if not name.endswith("_rgb.bsdf"):
        continue
    bsdf = load(os.path.join(sys.argv[1], name))
    for i in range(20):
        theta_i = math.radians(rng.uniform(1, 85) if i else 89)
        phi_i, u, v = rng.uniform(-math.pi, math.pi), rng.random(), rng.random()
        wi = direction(theta_i, phi_i)
        if i % 2:  # about the mirror direction, where values are largest
            theta = min(max(theta_i + math.radians(30 * (u - 0.5)), 0.05), 1.5)
            wo = direction(theta, phi_i + math.pi + 0.5 * (v - 0.5))
        else:
            wo = direction(math.acos(math.sqrt(1 - 0.98 * u)), 2 * math.pi * v)
        value = bsdf.eval(context, interaction(wi), mitsuba.Vector3f(*wo))
        density = bsdf.pdf(context, interaction(wi), mitsuba.Vector3f(*wo))
        values.append([name, wi, wo, [digits(value[k]) for k in range(3)], digits(density)])
    for i in range(4):
        wi = direction(math.radians(rng.uniform(1, 80)), rng.uniform(-math.pi, math.pi))
        u = [float(numpy.float32(rng.uniform(0.02, 0.98))) for _ in range(2)]
        drawn, _ = bsdf.sample(context, interaction(wi), 0.5, mitsuba.Point2f(*u))
        if drawn.pdf > 0:
            samples.append([name, wi, u, [digits(drawn.wo[k]) for k in range(3)], digits(drawn.pdf)])

print("{")
print(f'"oracle": "Mitsuba {mitsuba.__version__}, plugin measured, scalar_spectral",')
print('"values": "rows of file, wi (which indexes), wo, f cos(wo) in red, green, blue, density of wo",')
print('"samples": "rows of file, wi, u, the wo drawn with it, its density",')
for key, rows in (("value_rows", values), ("sample_rows", samples)):
    print(f'"{key}": [')
    print(",\n".join(json.dumps(row) for row in rows))
    print("]," if key == "value_rows" else "]")
print("}")
