"""The sweep's scenes: small, and each unlike those that ship."""

from dataclasses import replace

from darts_bench.sweep_copies import scaled
from darts_bench.scene_words import (SweepScene, at, body, camera, facing, frames, gate, lambert, lamp, looking, medium,
                                     room, steady)

FAST = ("spot-outside", "lamp-in-body", "orthographic-haze", "mixed-and-alpha", "zero-channels", "slow-and-fast")
KEPT = "camera paths keep the light that fog sends to visible surfaces, photons do not; so has the format"
BEAM = "a camera path cannot hit a light without a surface that shines in one direction"
WAVES = {"type": "bitmap", "file": "../assets/waves.pfm", "scale": 2.0}
STRIPES = {"type": "bitmap", "file": "../assets/stripes.pfm", "interpolate": False}


def scene(name, shows, media, primitives, view, integrator, radius=0.2, **fields):
    return SweepScene(name, shows, media, primitives, view, integrator, radius, **fields)


def dense(*parts, **fields):
    """Small bodies of dense fog: a radius that they are large for, and many photons, since most miss them."""
    return scene(*parts, radius=0.06, effort={"plain points": 2.0, "plain beams": 3.0, "best points": 2.0,
                                              "best beams": 2.0}, **fields)


def bulb(x=1.2, y=1.2, z=1.4, size=0.3, emission=40.0, outside=None, **fields):
    return lamp("sphere", at(x, y, z, size), emission, outside, **fields)


def several_media():
    thin, thick = medium("thin", 0.4), medium("thick", [5.0, 4.0, 3.0], 0.05)
    yield dense("nested-cubes", "a dense cube in a thin one in vacuum, light and camera outside", [thin, thick],
                [body("cube", at(0, 0, 0, 1.8, 25), "thin"), body("cube", at(0.1, 0, 0, 0.9, 50), "thick", "thin"), bulb()],
                camera(), gate(6.4, 7.4))
    yield dense("nested-spheres", "three spheres of fog in each other", [thin, thick, medium("core", 1.0, 1.0, 0.5)],
                [body("sphere", at(0, 0, 0, 0.9), "thin"), body("sphere", at(0, 0, 0, 0.6), "thick", "thin"),
                 body("sphere", at(0.1, 0, 0.1, 0.25), "core", "thick"), bulb()], camera(), gate(6.4, 7.4))
    yield dense("layers", "three layers of tissue (g 0.8), index-matched, lit and seen from outside",
                [medium("skin", 6.0, 0.2, 0.8), medium("fat", 3.0, 0.05, 0.8), medium("muscle", 8.0, 0.5, 0.8)],
                [body("cube", at(0, 0, 0, (1.6, 1.6, 1.2)), "fat"),
                 body("cube", at(0, 0, 0.4, (1.59, 1.59, 0.3)), "skin", "fat"),
                 body("cube", at(0, 0, -0.3, (1.59, 1.59, 0.5)), "muscle", "fat"), bulb()],
                camera(), gate(6.2, 7.6, 48))
    yield dense("cloud-in-haze", "a dense sphere in haze that holds light and camera", [medium("haze", 0.1), medium("cloud", 10.0)],
                [body("sphere", at(0, 0, 0, 0.5), "cloud", "haze"), bulb(outside="haze")], camera(inside="haze"),
                gate(6.4, 7.4, 64))
    yield dense("two-clouds", "two dense spheres of different colour beside each other in haze",
                [medium("haze", 0.15), medium("red", [6.0, 2.0, 1.0]), medium("blue", [1.0, 2.0, 6.0], 0.2, -0.4)],
                [body("sphere", at(-0.45, 0, 0, 0.4), "red", "haze"), body("sphere", at(0.45, 0, 0, 0.4), "blue", "haze"),
                 bulb(0, 1.2, 1.4, outside="haze")], camera(inside="haze"), gate(6.2, 7.2, 48))
    yield dense("two-rooms", "rooms of different fog that share an opening", [medium("left", 0.6), medium("right", 2.0, 0.1)],
                [body("cube", at(-0.5, 0, 0, 0.999), "left"), body("cube", at(0.5, 0, 0, 0.999), "right"),
                 bulb(-1.4, 0.8, 1.0), body("quad", facing((0, -0.35, 0), (1, -0.35, 0), 0.29), bsdf=lambert(0.3))],
                camera(), gate(6.0, 7.2))
    yield dense("tissue", "a block with g 0.8 lit from behind", [medium("tissue", 10.0, 0.1, 0.8)],
                [body("cube", at(0, 0, 0, (1.4, 1.4, 0.6)), "tissue"), bulb(0.8, 0.8, -1.6)], camera(),
                gate(6.6, 7.8, 64))


def inside_and_outside():
    fog = medium("fog", 1.0, 0.05)
    cube = at(0, 0, 0, 1.6, 20)
    yield dense("lamp-in-body", "a lamp inside a body of fog, seen from outside", [fog],
                [body("cube", cube, "fog"), bulb(0.3, 0.2, 0, 0.2, outside="fog")], camera(), gate(4.8, 5.8))
    yield dense("camera-in-body", "the camera inside a body of fog, the lamp outside", [fog],
                [body("cube", at(0, 0, 0, 3.0), "fog"), bulb(0.9, 0.9, -2.2)], camera((0, 0, 1.2), fov=50, inside="fog"),
                gate(3.4, 4.6))
    yield dense("behind-fog", "a wall seen through a slab of fog in front of it, lit beside the slab", [fog],
                [body("cube", at(0, 0, 0.8, (2, 2, 0.5)), "fog"), *room(3.0), bulb(0, 1.1, 0.2, 0.25)], camera(fov=24),
                gate(7.6, 8.8))
    yield dense("deep-cube", "a cube of 8 mean free paths, from afar", [medium("milk", 8.0, 0.02)],
                [body("cube", at(0, 0, 0, 1.0, 15), "milk"), bulb(2, 2, 4, 0.5, 60.0)], camera((0, 0, 8), fov=10), gate(12.0, 13.2, 96))
    yield dense("fog-ball-and-wall", "a fog ball that touches nothing lights a wall behind it", [medium("ball", 4.0, 0.0, 0.3)],
                [body("sphere", at(0.2, 0.1, 0.4, 0.5), "ball"), *room(2.6, [0.7, 0.5, 0.3]), bulb(0.9, 0.7, 0.9, 0.2)],
                camera(fov=26), gate(7.8, 9.2))


def refraction():
    milk = medium("milk", [2.0, 2.5, 3.0], 0.1, 0.3, 0.75)
    glass = {"type": "dielectric", "ior": 1.33}
    inner = lamp("sphere", at(0.1, 0.1, 0.0, 0.35), 20.0, "milk")
    yield scene("glass-ball-of-milk", "a lamp in milk in a refracting sphere", [milk],
                [body("sphere", at(0, 0, 0, 0.8), "milk", bsdf=glass), inner], camera(), gate(4.6, 6.0, 24), radius=0.08)
    yield scene("glass-cube-in-fog", "a refracting cube of milk with a lamp inside, in fog", [milk, medium("fog", 0.3)],
                [body("cube", at(0, 0, 0, 1.1, 30), "milk", "fog", glass), inner], camera(inside="fog"), gate(4.6, 6.0, 24),
                radius=0.08)
    yield scene("ior-one", "walls of index 1 refract nothing", [milk],
                [body("cube", at(0, 0, 0, 1.2, 30), "milk", bsdf={"type": "dielectric", "ior": 1.0}), inner], camera(),
                gate(4.6, 6.0, 24), radius=0.08)
    yield scene("rough-glass", "a lamp in milk in rough glass", [milk],
                [body("sphere", at(0, 0, 0, 0.8), "milk", bsdf={"type": "rough_dielectric", "ior": 1.3, "roughness": 0.3}),
                 inner], camera(), gate(4.6, 6.0, 24), radius=0.2)


def lights():
    fog = medium("fog", 0.5, 0.02)
    inside = dict(camera=camera(inside="fog"), media=[fog])
    target = (0.0, 0.0, 0.0)

    def lit(name, shows, *lamps, times=(6.2, 7.6), **fields):
        return scene(name, shows, inside["media"], [body("sphere", at(0, -0.3, 0, 0.35), bsdf=lambert(0.7)), *lamps],
                     inside["camera"], gate(*times), **fields)

    where = (1.1, 1.1, 1.0)
    yield lit("quad-light", "a quad in fog, and a ball", lamp("quad", facing(where, target, 0.6), 30.0, "fog"))
    yield lit("disk-light", "a disk in fog, given by its power", {**lamp("disk", facing(where, target, 0.4), 1.0, "fog"),
                                                                  "power": [40, 30, 20]})
    yield lit("cube-light", "a turned cube that shines on all sides", lamp("cube", at(*where, 0.4, 30), 20.0, "fog"))
    yield lit("mesh-light", "a ball of triangles that shines", lamp("mesh", at(*where, 0.3), 20.0, "fog",
                                                                    file="../assets/ball.obj"))
    yield lit("point-light", "a point in fog beside the picture", lamp("point", at(*where), 5.0, "fog"))
    yield lit("spot-light", "a spot across the picture", lamp("spot", looking((1.6, 0.6, 0), (0, 0, 0)), 8.0, "fog",
                                                              cone_angle=35,
                                                              edge_angle=10), times=(6.0, 7.4))
    yield lit("laser", "a collimated beam of finite radius across the picture",
              {**lamp("collimated", looking((1.5, 0.3, 0), (0, 0.3, 0)), 60.0, "fog"), "radius": 0.1}, times=(6.0, 7.4),
              without={"plain paths": BEAM, "best paths": BEAM})
    yield lit("pulses", "lamps of several shapes that flash at different times", lamp("quad", facing(where, target, 0.5),
                                                                                      20.0, "fog"),
              bulb(-1.2, 1.0, 0.8, 0.25, [5, 20, 40], "fog", emission_time=0.4),
              lamp("disk", facing((0, -1.4, 1), target, 0.3), [40, 10, 5], "fog", emission_time=-0.3))
    yield dense("spot-outside", "a spot outside shines into a cube of fog", [fog],
                [body("cube", at(0, 0, 0, 1.5), "fog"), lamp("spot", looking((1.6, 1.2, 0.5), target), 30.0, cone_angle=25)],
                camera(), gate(6.4, 7.8))
    yield dense("sky", "a cloud and a ball under a constant sky, in steady state", [medium("cloud", 2.0, 0.2, 0.5)],
                [body("sphere", at(0, 0.2, 0, 0.6), "cloud"), body("quad", facing((0, -0.7, 0), (0, 1, 0), 3.0),
                                                                   bsdf=lambert(0.6)),
                 lamp("infinite_sphere", at(0, 0, 0), [1.0, 1.2, 1.5])], camera((0, 0.5, 5)), steady())


def cameras():
    haze = medium("haze", 0.3, 0.0, 0.4)
    things = [body("sphere", at(-0.3, 0, 0, 0.3), bsdf=lambert([0.7, 0.3, 0.2])),
              body("cube", at(0.4, -0.2, -0.4, 0.5, 30), bsdf=lambert(0.5)), bulb(outside="haze")]
    yield scene("thinlens-haze", "a wide lens focused in front of things in haze", [haze], things,
                camera(kind="thinlens", inside="haze", aperture_size=0.25, focus_distance=4.0), gate(6.2, 7.6))
    yield scene("orthographic-haze", "parallel rays through haze", [haze], things,
                camera(kind="orthographic", inside="haze", orthographic_size=0.8), gate(6.2, 7.6))
    cloud = [body("sphere", at(0, 0, 0, 0.7), "cloud"), bulb()]
    yield dense("orthographic-cloud", "a cloud seen by parallel rays from outside", [medium("cloud", 4.0)], cloud,
                camera(kind="orthographic", orthographic_size=0.8), gate(6.4, 7.6))
    yield dense("thinlens-cloud", "a cloud seen through a wide lens from outside", [medium("cloud", 4.0)], cloud,
                camera(kind="thinlens", aperture_size=0.2, focus_distance=4.5), gate(6.4, 7.6))
    yield scene("unwarped-mirror", "camera_unwarped, with a mirror in fog", [haze],
                [*things, body("quad", facing((0.9, 0.2, -0.8), (0, 0.2, 1.5), 1.6), bsdf={"type": "mirror", "albedo": 0.9})],
                camera(inside="haze", fov=24), gate(1.8, 3.0, camera_unwarped=True))


def surfaces():
    fog = medium("fog", 0.4)
    lit = dict(media=[fog], view=camera(inside="fog", fov=24))

    def inner(name, shows, *things, times=(6.0, 7.6), **fields):
        integrator = gate(*times, **fields.pop("switches", {}))
        return scene(name, shows, lit["media"], [*things, bulb(0.6, 0.8, 1.0, 0.25, outside="fog")], lit["view"], integrator,
                     **fields)

    back = body("quad", facing((0, 0, -0.8), (0, 0, 5), 2.6), bsdf=lambert([0.5, 0.6, 0.7]))
    yield inner("bump-and-smooth", "a bumpy wall, and a ball of triangles with smooth normals",
                body("quad", facing((0, 0, -0.8), (0, 0, 5), 2.6), bsdf=lambert(0.6, bump=WAVES)),
                body("mesh", at(0, 0, 0, 0.5), bsdf=lambert(0.7), file="../assets/ball.obj", smooth=True))
    yield inner("mixed-and-alpha", "mixed materials and half-transparent cards, fog and lamp behind them", back,
                body("quad", facing((-0.4, 0, 0.2), (0, 0, 5), 0.8),
                     bsdf={"type": "transparency", "alpha": STRIPES, "base": lambert([0.8, 0.4, 0.2])}),
                body("quad", facing((0.4, 0, 0.2), (1.5, 0, -5), 0.8),
                     bsdf={"type": "transparency", "alpha": 0.6, "base": lambert(0.7)}),
                body("sphere", at(0, -0.5, 0.2, 0.25),
                     bsdf={"type": "mixed", "ratio": 0.4, "bsdf0": lambert(0.8), "bsdf1": {"type": "rough_conductor",
                                                                                           "material": "Au",
                                                                                         "roughness": 0.3}}))
    yield inner("glossy", "rough metal and rough plastic in fog",
                body("quad", facing((0, -0.7, 0), (0, 1, 0), 2.6), bsdf={"type": "rough_plastic", "albedo": 0.5,
                                                                         "roughness": 0.25}),
                body("sphere", at(0, 0, 0, 0.45), bsdf={"type": "rough_conductor", "material": "Cu", "roughness": 0.35}))
    yield inner("specular", "a mirror, a metal ball and smooth plastic in fog", back,
                body("quad", facing((-0.6, 0, -0.4), (0.5, 0, 2), 1.0), bsdf={"type": "mirror"}),
                body("sphere", at(0.5, 0.3, 0, 0.3), bsdf={"type": "conductor", "material": "Al"}),
                body("sphere", at(0.3, -0.5, 0.3, 0.3), bsdf={"type": "plastic", "albedo": [0.2, 0.5, 0.7]}))
    yield inner("one-sided", "rough chalk that is black from behind, shading on one side", back,
                body("quad", facing((-0.4, 0, 0.2), (-1, 0, -5), 0.7), bsdf={"type": "oren_nayar", "albedo": 0.7,
                                                                             "sigma": 0.5}),
                body("quad", facing((0.4, 0, 0.2), (1, 0, 5), 0.7), bsdf={"type": "oren_nayar", "albedo": 0.7, "sigma": 0.5}),
                switches={"enable_two_sided_shading": False})


def odd_bodies():
    fog, dense_fog = medium("fog", 0.3), medium("dense", 3.0, 0.05)
    view = camera(inside="fog")
    veil = {"type": "transparency", "alpha": 0.4, "base": lambert(0.7)}
    yield dense("veiled-fog", "dense fog behind half-transparent walls", [fog, dense_fog],
                [body("cube", at(0, 0, 0, 1.1, 30), "dense", "fog", veil), bulb(outside="fog")], view, gate(6.2, 7.4))
    yield dense("striped-fog", "dense fog behind walls with holes, lamp and camera in vacuum", [dense_fog],
                [body("cube", at(0, 0, 0, 1.1, 30), "dense", bsdf={**veil, "alpha": STRIPES}), bulb()], camera(), gate(6.2, 7.4))
    yield dense("mesh-of-fog", "fog in a stretched ball of triangles", [dense_fog],
                [body("mesh", at(0, 0, 0, (0.7, 0.5, 0.7), 20), "dense", file="../assets/ball.obj"), bulb()], camera(),
                gate(6.4, 7.4))
    yield dense("fog-on-wall", "fog that touches a wall, just under a lamp", [dense_fog],
                [body("cube", at(0, 0, -0.2, 1.0), "dense"), body("quad", facing((0, 0, -0.7005), (0, 0, 5), 2.6),
                                                                  bsdf=lambert(0.6)),
                 lamp("quad", facing((0, 0.55, -0.2), (0, 0, -0.2), 0.5), 20.0)], camera(), gate(5.2, 6.4))
    yield scene("textured-light", "a wall of stripes and a lamp of stripes in fog", [fog],
                [body("quad", facing((0, 0, -0.8), (0, 0, 5), 2.6), bsdf=lambert({**STRIPES, "scale": 0.8})),
                 lamp("quad", facing((1.1, 1.1, 1.0), (0, 0, 0), 0.6), 30.0, "fog"),
                 lamp("quad", facing((-1.1, 1.1, 1.0), (0, 0, 0), 0.6), {**STRIPES, "interpolate": True, "scale": 30.0},
                      "fog")],
                view, gate(6.2, 7.6))


def media_and_colours():
    def filled(name, shows, fog, lamps=None, integrator=None, **fields):
        return scene(name, shows, [fog], [*(lamps or [bulb(outside="fog")]), body("sphere", at(0, -0.2, 0, 0.3),
                                                                                  bsdf=lambert([0.7, 0, 0.2]))],
                     camera(inside="fog"), integrator or gate(6.2, 7.6), **fields)

    yield filled("zero-channels", "fog that scatters no green, absorbs no red; a ball without green",
                 medium("fog", [0.8, 0.0, 0.4], [0.0, 0.3, 0.1]), [bulb(emission=[40, 30, 10], outside="fog")])
    yield filled("backward", "fog with g -0.4 and a density", medium("fog", 0.4, 0.01, -0.4, density=1.5))
    yield filled("forward", "fog with g 0.6", medium("fog", 0.8, 0.02, 0.6))
    yield filled("rayleigh", "Rayleigh scattering", {**medium("fog", [0.2, 0.4, 0.8]), "phase_function": {"type": "rayleigh"}})
    yield filled("guided-homo", "the fork's medium and phase function", {**medium("fog", 0.6, 0.05), "type": "guided_homo",
                                                                       "phase_function": {"type": "henyey_greenstein",
                                                                                          "g": 0.3}})
    yield filled("absorber", "fog that mostly absorbs", medium("fog", 0.3, 0.9))


def units_and_speeds():
    base = next(several_media())
    for name, length, time in (("millimetres", 1e-3, 1.0), ("ten-thousands", 1e4, 1e4), ("nanoseconds", 1.0, 3.336e-9)):
        yield replace(scaled(base, length, time), name=name, shows=f"nested-cubes in lengths of {length:g}, times of {time:g}")
    fast, slow = medium("fast", 0.5, 0.02, speed=1.5), medium("slow", 2.0, 0.02, speed=0.5)
    yield dense("slow-and-fast", "a slow cube in fast fog, vacuum at 0.8", [fast, slow],
                [body("cube", at(0, 0, 0, 1.8), "fast"), body("cube", at(0, 0, 0, 0.8, 30), "slow", "fast"), bulb()], camera(),
                {**gate(7.8, 9.2), "vaccum_speed_of_light": 0.8})
    yield scene("slow-vacuum", "a body of slow vacuum around a ball, in fog", [medium("fog", 0.4)],
                [body("cube", at(0, 0, 0, 1.2, 20), outside="fog", int_speed_of_light=0.6),
                 body("sphere", at(0, 0, 0, 0.35), bsdf=lambert(0.7)), bulb(outside="fog")], camera(inside="fog"), gate(6.4, 8.2))


def switches():
    fog, thick = medium("fog", 0.5, 0.02), medium("thick", 1.5, 0.05)
    ball = body("sphere", at(0, -0.2, 0, 0.35), bsdf=lambert(0.7))
    inside = camera(inside="fog")

    def switched(name, shows, integrator, *more, view=inside, **fields):
        return scene(name, shows, [fog], [*more, ball, bulb(outside="fog")], view, integrator, **fields)

    yield switched("sequence", "eight frames", frames(5.6, 0.3, 8))
    yield dense("sequence-outside", "six frames of a body of fog seen from outside", [thick],
                [body("cube", at(0, 0, 0, 1.0, 20), "thick"), bulb()], camera(), frames(6.2, 0.3, 6))
    yield switched("integral", "frames that integrate", frames(6.0, 0.7, 2, time_normalization="integral"))
    yield scene("no-low-orders", "low_order_scattering off, in fog alone", [thick], [bulb(outside="thick")],
                camera(inside="thick"),
                gate(5.8, 7.6, low_order_scattering=False))
    yield switched("no-surfaces", "include_surfaces off", gate(5.8, 7.6, include_surfaces=False),
                   without={"plain paths": KEPT, "best paths": KEPT})
    yield switched("few-bounces", "bounces 2 and 3 only, through a forward surface that counts", gate(5.8, 8.0, 4, min_bounces=2),
                   body("cube", at(0, 0, 0, 1.2, 30)))
    yield switched("gaussian-response", "a sensor with a Gaussian response",
                   {"max_bounces": 32, "vaccum_speed_of_light": 1.0,
                    "temporal_response": {"type": "gaussian", "center": 6.8, "sigma": 0.3}})
    yield switched("single-frames", "light paths that aim at one frame each", frames(5.8, 0.6, 3, single_frames=True))
    yield switched("steady-fog", "everything that arrives", steady())
    yield switched("roulette", "roulette of dark paths", gate(5.8, 7.6, enable_rr=True))
    yield switched("consistency", "consistency checks on smooth and bumpy things", gate(5.8, 7.6,
                                                                                        enable_consistency_checks=True),
                   body("mesh", at(0.4, 0.3, 0.2, 0.35), bsdf=lambert(0.7), file="../assets/ball.obj", smooth=True),
                   body("quad", facing((0, 0, -0.8), (0, 0, 5), 2.6), bsdf=lambert(0.6, bump=WAVES)))
    yield switched("one-map", "the same photons in every pass", gate(5.8, 7.6, photon_map="transient_photon_map"))
    yield switched("steps", "passes of several samples a pixel", gate(5.8, 7.6), renderer={"spp_step": 2})
    for filter in ("tent", "gaussian", "mitchell_netravali"):
        yield switched(f"{filter.split('_')[0]}-filter", "a reconstruction filter wider than a pixel", gate(5.8, 7.6),
                       view={**inside, "reconstruction_filter": filter, "resolution": [20, 12]})


def all_scenes():
    """In the order of the report; names are unique."""
    groups = (several_media, inside_and_outside, refraction, lights, cameras, surfaces, odd_bodies, media_and_colours,
              units_and_speeds, switches)
    return [entry for group in groups for entry in group()]
