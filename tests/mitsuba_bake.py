"""Reads a baked equirect sky with Mitsuba 3 as an environment light, without any rotation, and prints what it finds.

usage: mitsuba_bake.py SKY.exr SKY.json planes|up    exit code 3: Mitsuba is not installed

planes: five planes, and the brightest azimuth at the elevation of the sun. up: a horizontal plane, without the sun and with the
sun that the JSON file says to add.

Mitsuba's envmap has +Y up, its first column at -Z and grows toward +X: with +Y up and -Z north that is azimuth clockwise
from north, so `to_world` stays the identity.
"""

import json
import sys

try:
    import mitsuba as mi
except ImportError as error:
    print(error)
    sys.exit(3)

mi.set_variant("scalar_rgb")


def sampled(meter, **more):
    """A meter of one pixel."""
    return {
        "type": meter,
        "sampler": {"type": "multijitter", "sample_count": 1 << 18},
        "film": {"type": "hdrfilm", "width": 1, "height": 1, "pixel_format": "rgb",
                 "rfilter": {"type": "box"}, "component_format": "float32"},
        **more,
    }


def plane(normal, reflectance, **more):
    """A small rectangle that faces `normal`."""
    up = [0, 0, 1] if abs(normal[2]) < 0.9 else [1, 0, 0]
    return {
        "type": "rectangle",
        "to_world": mi.ScalarTransform4f().look_at([0, 0, 0], normal, up),
        "bsdf": {"type": "diffuse", "reflectance": reflectance},
        **more,
    }


def measured(path, **parts):
    """What the meter among the parts of a scene under the sky measures, linear RGB."""
    sky = {"type": "envmap", "filename": path}
    pixel = mi.render(mi.load_dict({"type": "scene", "integrator": {"type": "direct"}, "sky": sky, **parts}))
    return [float(pixel.array[c]) for c in range(3)]


def irradiance(path, normal):
    """Irradiance (linear RGB) of a plane that faces `normal`, by an irradiance meter on a small rectangle."""
    return measured(path, plane=plane(normal, 0.0, meter=sampled("irradiancemeter")))


def illuminated(path, lights):
    """Irradiance (linear RGB) of a plane that faces up, from the light that a white matt plane reflects: an irradiance meter does not
    meet the light of a direction."""
    meter = sampled("radiancemeter", origin=[0.1, 1, 0.2], direction=[0, -1, 0])
    radiance = measured(path, **lights, plane=plane([0, 1, 0], 1.0), meter=meter)
    return [3.141592653589793 * value for value in radiance]


def brightest_azimuth(path, elevation):
    """Azimuth, degrees clockwise from north, of the most radiant direction at `elevation`, asked of the emitter."""
    import math
    emitter = mi.load_dict({"type": "scene", "sky": {"type": "envmap", "filename": path}}).environment()
    best = (-1.0, 0.0)
    for step in range(36000):
        azimuth = math.radians(step / 100)
        e = math.radians(elevation)
        d = [math.sin(azimuth) * math.cos(e), math.sin(e), -math.cos(azimuth) * math.cos(e)]
        si = mi.SurfaceInteraction3f()
        si.wi = mi.Vector3f([-c for c in d])  # the interaction looks back along the ray
        best = max(best, (float(emitter.eval(si)[1]), step / 100))
    return best[1]


path, sidecar, mode = sys.argv[1:]
with open(sidecar) as file:
    sun = json.load(file)["sun"]
found = {"mitsuba": mi.__version__}
if mode == "planes":
    normals = {"+y": [0, 1, 0], "+x": [1, 0, 0], "-x": [-1, 0, 0], "+z": [0, 0, 1], "-z": [0, 0, -1]}
    found["irradiance"] = {name: irradiance(path, n) for name, n in normals.items()}
    found["azimuth"] = brightest_azimuth(path, sun["elevation_deg"])
else:
    light = {
        "type": "directional",
        "direction": [-c for c in sun["direction"]],
        "irradiance": {"type": "rgb", "value": sun["illuminance_rgb"]},
    }
    found["sky"] = illuminated(path, {})
    found["sky_and_sun"] = illuminated(path, {"sun": light})
print(json.dumps(found))
