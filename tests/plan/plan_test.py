#!/usr/bin/python3
"""The plan of `--explain=json`: for every effect a scene that has it and one that lacks it. The plan names the element behind it; after
a render its counters have counted, and are zero where it is off. The renderer is named by the environment's TUNGSTEN."""

import copy
import json
import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))

from renders import render_all  # noqa: E402

TUNGSTEN = os.environ.get("TUNGSTEN", str(Path(__file__).resolve().parents[2] / "build/bin/tungsten"))

PATHS = {"type": "path_tracer", "max_bounces": 6, "transient_time_center": 4, "transient_time_width": 4}
PHOTONS = {**PATHS, "type": "progressive_transient_photon_map", "photon_count": 2000, "volume_photon_count": 2000,
           "gather_radius": 0.2, "volume_gather_radius": 0.2}
ROOM = {
    "media": [{"name": "fog", "type": "homogeneous", "sigma_s": 0.5}],
    "bsdfs": [{"name": "glass", "type": "dielectric", "ior": 1.5}],
    "primitives": [
        {"name": "floor", "type": "quad", "bsdf": {"type": "lambert", "albedo": 0.6}, "transform": {"scale": 4}},
        {"name": "lamp", "type": "point", "emission": 8, "transform": {"position": [0.5, 1.8, 0.6]}}],
    "camera": {"type": "pinhole", "resolution": [8, 8], "fov": 60,
               "transform": {"position": [0, 1, 2.5], "look_at": [0, 0.4, 0], "up": [0, 1, 0]}},
    "integrator": PATHS, "renderer": {"spp": 2, "spp_step": 2}}


def room(integrator=None, surface=None, medium=None, **changes):
    """The room with a further surface (a cube), with fog or another medium, or with fields by path."""
    scene = copy.deepcopy(ROOM)
    scene["integrator"] = dict(integrator or PATHS)
    if surface:
        scene["primitives"].append({"name": "thing", "type": "cube", "transform": {"position": [0.1, 0.5, 0]}, **surface})
    if medium is not None:
        scene["media"][0].update(medium)
        scene["camera"]["medium"] = "fog"
        scene["primitives"][1]["ext_medium"] = "fog"
    return edited(scene, changes)


def edited(scene, changes):
    """With fields by path."""
    for path, value in changes.items():
        at = scene
        *parts, last = path.split("__")
        for part in parts:
            at = at[int(part) if part.isdigit() else part]
        at[last] = value
    return scene


def foggy(integrator=None, **changes):
    return room(integrator, medium={}, **changes)


def best(integrator=PHOTONS, **darts):
    return {**integrator, "darts": {"preset": "best", **darts} if darts else "best"}


LAMP = {"type": "quad", "emission": 1, "transform": {"position": [0, 1.9, 0], "rotation": [180, 0, 0]}}
GLOSSY = {"bsdf": {"type": "rough_conductor", "roughness": 0.2}}
STEADY = {"transient_time_width": 0, "transient_time_center": 0}
CHECKER = {"type": "checker", "on_color": 0.8, "off_color": 0.2}
OTHER_PULSE = {"name": "late", "type": "point", "emission": 8, "emission_time": 9, "transform": {"position": [0, 1, 0]}}
FAR_FOG = {"bsdf": {"type": "forward"}, "int_medium": "fog", "transform": {"position": [0, 0.5, -9]}}
FRAMED = {**{name: PHOTONS[name] for name in PHOTONS if "center" not in name}, "start_time": 2, "transient_time_width": 1, "frame_num": 4}

DARK_LAMP = {"name": "ceiling", "type": "quad", "bsdf": {"type": "null"}, "emission": 8,
             "transform": {"position": [0, 1.9, 0], "scale": 2, "rotation": [180, 0, 0]}}


def sealed(wall):
    """Fog in a cube under a lamp, nothing else scatters."""
    scene = room(best(PATHS), surface={"bsdf": wall, "int_medium": "fog"}, media__0__sigma_s=2)
    scene["primitives"][0] = DARK_LAMP
    return scene


def tissue(end=2000, side=20, absorption=0.01, **changes):
    """Millimetres and picoseconds: a cube of tissue with a fibre beside it, until `end`."""
    scene = {"media": [{"name": "tissue", "type": "homogeneous", "sigma_s": 10, "sigma_a": absorption, "speed_of_light": 0.214137,
                        "phase_function": {"type": "henyey_greenstein", "g": 0.9}}],
             "primitives": [{"name": "body", "type": "cube", "bsdf": {"type": "forward"}, "int_medium": "tissue", "transform": {"scale": side}},
                            {"name": "fibre", "type": "point", "emission": 1, "transform": {"position": [0, side / 2 + 0.01, 0]}}],
             "camera": {"resolution": [4, 4], "transform": {"position": [0, side, 0], "look_at": [0, 0, 0], "up": [1, 0, 0]}},
             "integrator": {"type": "path_tracer", "max_bounces": 100000, "vacuum_speed_of_light": 0.299792, "start_time": 0,
                            "transient_time_width": end / 4, "frame_num": 4},
             "renderer": {"spp": 1}}
    return edited(scene, changes)


# effect, a scene that has it, an element behind it, a scene that lacks it
EFFECTS = [
    ("time of flight", room(), "integrator", room({**PATHS, **STEADY})),
    ("frames", room({**PATHS, "start_time": 2, "transient_time_width": 1, "frame_num": 4}), "integrator.frame_num", room()),
    ("delta gate", foggy({**PHOTONS, "delta_time_gate": True}), "integrator.delta_time_gate", room()),
    ("temporal response", room({k: v for k, v in PATHS.items() if "transient" not in k}
                               | {"temporal_response": {"times": [2, 4, 6], "values": [0, 1, 0]}}),
     "integrator.temporal_response", room()),
    ("emission times", room(primitives__1__emission_time=0.5), "primitives[1].emission_time", room()),
    ("medium scattering", foggy(), "media[0]", room()),
    ("medium scattering", foggy(PHOTONS), "media[0]", room(PHOTONS)),
    ("absorption only", room(medium={"sigma_s": 0, "sigma_a": 0.3}), "media[0]", foggy()),
    ("absorption only", room(PHOTONS, medium={"sigma_s": 0, "sigma_a": 0.3}), "media[0]", foggy(PHOTONS)),
    ("coloured media", room(medium={"sigma_s": [0.3, 0.5, 0.7]}), "media[0]", foggy()),
    ("anisotropic scattering", room(medium={"phase_function": {"type": "henyey_greenstein", "g": 0.5}}),
     "media[0].phase_function", foggy()),
    ("surface scattering", room(), "primitives[0].bsdf", room(primitives__0__bsdf={"type": "null"})),
    ("specular camera subpaths", room(surface={"bsdf": {"type": "mirror"}}), "primitives[2].bsdf", room(surface=GLOSSY)),
    ("specular camera subpaths", room(PHOTONS, surface={"bsdf": "glass"}), "bsdfs.glass", room(PHOTONS)),
    ("refraction", room(surface={"bsdf": "glass"}), "bsdfs.glass", room(surface={"bsdf": {"type": "mirror"}})),
    ("refraction", room(PHOTONS, surface={"bsdf": "glass"}), "bsdfs.glass", room(PHOTONS)),
    ("index-matched boundaries", room(surface={"bsdf": {"type": "forward"}}), "primitives[2].bsdf", room()),
    ("several speeds of light", room(surface={"bsdf": {"type": "forward"}, "int_speed_of_light": 0.5, "ext_speed_of_light": 1}),
     "primitives[2]", room()),
    ("emission from surfaces", room(surface=LAMP), "primitives[2]", room()),
    ("environment", room({**PATHS, **STEADY}, surface={"type": "infinite_sphere", "emission": 1}), "primitives[2]",
     room({**PATHS, **STEADY})),
    ("textures", room(primitives__0__bsdf={"type": "lambert", "albedo": CHECKER}), "primitives[0].bsdf", room()),
    ("textures", room(surface=LAMP | {"emission": CHECKER}), "primitives[2]", room(surface=LAMP)),
    ("alpha", room(surface={"bsdf": {"type": "transparency", "base": {"type": "lambert"}, "alpha": 0.5}}), "primitives[2].bsdf",
     room(surface=GLOSSY)),
    ("late emitters left out", room(surface=OTHER_PULSE), "primitives[2]", room(surface=OTHER_PULSE | {"emission_time": 1})),
    ("black image", room(primitives__1__emission_time=9), "primitives[1]", room()),
    ("frames before all light", room({**PATHS, "start_time": 0, "transient_time_width": 1, "frame_num": 9}), "integrator.start_time",
     room({**PATHS, "start_time": 2, "transient_time_width": 1, "frame_num": 4})),
    ("surfaces in time", room(), "primitives", foggy({**PATHS, "transient_time_width": 0.2, "transient_time_center": 2.5},
                                                     primitives__0__transform={"position": [0, -9, 0]})),
    ("media in time", foggy(), "media[0]", room(surface=FAR_FOG)),
    ("late light cut by max_bounces", tissue(), "media[0].max_bounces", tissue(media__0__max_bounces=4400)),
    ("late light cut by max_bounces", tissue(media__0__max_bounces=4400, integrator__max_bounces=200), "integrator.max_bounces", room()),
    ("guided paths", foggy(best(PATHS)), "integrator.darts", room(best(PATHS), surface=FAR_FOG)),
    ("volume photon points", foggy(PHOTONS), "integrator.volume_photon_type", room(PHOTONS, surface=FAR_FOG)),
    ("one frame per light path", foggy(best(FRAMED, single_frames=True)), "integrator.darts", foggy(best(FRAMED))),
    ("Russian roulette", room({**PATHS, "enable_rr": True}), "integrator.enable_rr", room()),
    ("guided paths", foggy(best(PATHS)), "integrator.darts", foggy()),
    ("refractive connections", sealed("glass"), "integrator.darts", sealed({"type": "forward"})),
    ("EDA table", foggy(best(PATHS, direction="eda")), "integrator.darts", foggy(best(PATHS, direction="connection"))),
    ("light vertices", foggy(best(PATHS)), "integrator.darts", foggy(best(PATHS, surface_connections=False))),
    ("glossy light vertices", foggy(best(PATHS), surface=GLOSSY), "primitives[2].bsdf", foggy(best(PATHS))),
    ("light paths", room({**PATHS, "type": "light_tracer"}), "integrator.type", room()),
    ("volume photon points", foggy(PHOTONS), "integrator.volume_photon_type", room(PHOTONS)),
    ("photon beams", foggy({**PHOTONS, "volume_photon_type": "beams"}), "integrator.volume_photon_type", foggy(PHOTONS)),
    ("splatting", foggy(PHOTONS), "camera", room(PHOTONS)),
    ("gathering", foggy(PHOTONS, camera__type="thinlens", camera__aperture_size=0.05), "camera", foggy(PHOTONS)),
    ("extra camera paths", foggy(best()), "camera", foggy(best(), camera__resolution=[200, 200])),
    ("extra camera paths", foggy(best()), "camera", foggy({**PHOTONS, "darts": "published"})),
    ("extra camera paths", foggy(best({**PHOTONS, "volume_photon_type": "mis_volumes_balls"})), "camera",
     foggy({**PHOTONS, "volume_photon_type": "mis_volumes_balls"})),
    ("extra camera paths", foggy(best(), camera__type="orthographic"), "camera", foggy(PHOTONS, camera__type="orthographic")),
    ("temporal kernel", foggy({**PHOTONS, "delta_time_gate": True}), "integrator.delta_time_gate", foggy(PHOTONS)),
    ("surface photons", room(PHOTONS), "primitives[0].bsdf", room({**PHOTONS, "include_surfaces": False})),
    ("surface photons", room(PHOTONS), "primitives[0].bsdf",
     foggy({**PHOTONS, "transient_time_width": 0.2, "transient_time_center": 2.5}, primitives__0__transform={"position": [0, -9, 0]})),
    ("guided light paths", foggy(best(plain_share=0.5)), "integrator.darts", foggy(PHOTONS)),
    ("EDA table", foggy(best(direction="eda")), "integrator.darts", foggy(best(direction="connection"))),
    ("surface connections", foggy(best()), "integrator.darts", foggy(best(surface_connections=False))),
    ("path reuse between pixels", foggy(best()), "integrator.darts", foggy(PHOTONS)),
    ("glossy camera subpaths", foggy(best(), surface=GLOSSY), "primitives[2].bsdf", foggy(best(glossy_sensor_paths=False), surface=GLOSSY)),
    ("exact arrival culling", foggy(PHOTONS), "integrator", foggy(PHOTONS, surface={"bsdf": {"type": "mirror"}})),
] + [("sliced primitives", foggy({**PHOTONS, "volume_photon_type": kind}), "integrator.volume_photon_type",
      foggy({**PHOTONS, "volume_photon_type": "beams"}))
     for kind in ("planes", "volumes", "balls", "volumes_balls", "mis_volumes_balls", "hypervolumes")]


class Plan(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def run_on(self, scene, *options):
        file = Path(self.folder.name) / "scene.json"
        file.write_text(json.dumps(scene))
        done = subprocess.run([TUNGSTEN, "--quiet", *options, str(file)], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done

    plans = {}  # by the scene's text: many scenes below are the same

    def plan(self, scene):
        text = json.dumps(scene)
        if text not in self.plans:
            self.plans[text] = json.loads(self.run_on(scene, "--explain=json").stdout)
        return self.plans[text]

    def effect(self, effects, name):
        found = [effect for effect in effects if effect["name"] == name]
        self.assertLessEqual(len(found), 1, "effects are described once")
        return found[0] if found else None

    def rendered(self, scenes):
        """Effects of each of the scenes, as a render leaves them with its image."""
        films = render_all(TUNGSTEN, self.folder.name, scenes, "-s", "3")
        return [metadata["statistics"]["effects"] for _, metadata in films]

    def test_statistics_hold_the_effects_of_the_image(self):
        scene, file = foggy(best()), Path(self.folder.name) / "stats.json"
        self.run_on(scene, "-d", self.folder.name, "--stats", str(file), "-s", "3")
        self.assertEqual(json.loads(file.read_text())["effects"], self.rendered([scene])[0])

    def test_every_effect_is_on_where_it_is_called_for_and_off_elsewhere(self):
        for name, has, element, lacks in EFFECTS:
            with self.subTest(effect=name):
                on, off = (self.effect(self.plan(scene)["effects"], name) for scene in (has, lacks))
                self.assertTrue(on["on"], on)
                self.assertIn(element, on["causes"])
                self.assertTrue(on["reason"])
                if off is None:
                    continue
                self.assertFalse(off["on"], off)
                self.assertEqual(off["causes"], [])
                self.assertNotEqual(on["reason"], off["reason"])

    def test_light_that_bounces_cut_is_told_where_there_is_any(self):
        """By the mean number of scatterings, sigma_s c t: 10 * 0.214137 * 478 = 1024. What leaks away or is absorbed before is not missed."""
        def warning(**changes):
            return self.run_on(tissue(**changes), "--explain").stderr
        told = warning(side=200)
        for part in ("media[0].max_bounces: late light cut by max_bounces", "'tissue'", "1024 of the medium"):
            self.assertIn(part, told)
        after, latest = (float(number) for number in re.search(r"after about (\S+) .* some (\S+) times", told).groups())
        outside = 100.01 / 0.299792  # from the fibre into the body, and from there on to the camera
        self.assertAlmostEqual(after, outside + 1024 / 2.14137, delta=0.5)
        self.assertAlmostEqual(latest, 2.14137 * (2000 - outside), delta=2)
        self.assertEqual(warning(side=200, media__0__max_bounces=4400), "")
        self.assertEqual(warning(end=470), "", "none arrives that late")
        self.assertEqual(warning(side=2), "", "what is left after 478 ps is e^-92 of it")
        self.assertEqual(warning(side=200, absorption=0.2), "", "absorbed: e^-20")

    def test_what_is_off_counts_nothing(self):
        rendered = self.rendered([scene for _, has, _, lacks in EFFECTS for scene in (has, lacks)])
        for (name, _, _, _), with_it, without in zip(EFFECTS, rendered[::2], rendered[1::2]):
            with self.subTest(effect=name):
                on, off = self.effect(with_it, name), self.effect(without, name)
                if on["counters"]:
                    self.assertGreater(sum(on["counters"].values()), 0, on)
                if off is not None:
                    self.assertEqual(sum(off["counters"].values()), 0, off)

    def test_every_effect_of_every_plan_that_is_off_counts_nothing(self):
        integrators = (PATHS, PHOTONS, best(PATHS), best(), {**PATHS, "type": "light_tracer"})
        scenes = [scene for one in integrators for scene in (room(one), foggy(one), foggy(one, surface=GLOSSY))]
        for effect in (effect for effects in self.rendered(scenes) for effect in effects):
            if not effect["on"]:
                self.assertEqual(sum(effect["counters"].values()), 0, effect)

    def test_text_and_json_say_the_same(self):
        scene = foggy(best())
        text = self.run_on(scene, "--explain=effects").stdout.splitlines()[1:]
        text, left_open = text[:text.index("what the scene leaves open")], text[text.index("what the scene leaves open") + 1:]
        plan = self.plan(scene)
        effects = plan["effects"]
        self.assertEqual(len(text), len(effects))
        for line, effect in zip(text, effects):
            self.assertTrue(line.startswith("  on  " if effect["on"] else "  off "), line)
            self.assertIn(effect["name"], line)
            self.assertTrue(line.endswith(effect["reason"]), line)
        self.assertEqual([re.sub(" +", " ", line).strip() for line in left_open],
                         [f"{taken['field']} {taken['value']} ({taken['meaning']})" for taken in plan["defaults"]])

    def test_three_lines_say_what_is_sampled_how(self):
        for settings, parts in [
            (best(PATHS), ["plain and guided camera paths side by side", "a pilot will choose", "by the light still to arrive in time (causal)",
                      "control vertices; connections to lights"]),
            (best(PATHS, plain_share=0.25), ["plain_share gives plain ones 0.25 of the time"]),
            (best(PATHS, plain_share=0), ["guided camera paths alone: plain_share is 0"]),
            ({**PATHS, "darts": {"preset": "published", "direction": "eda"}}, ["guided camera paths alone: the published method",
                                                             "resampled by the light still to arrive in time (diffusion)", "the published table"]),
            (PATHS, ["plain camera paths: the scene does not ask for it", "distances by transmittance"]),
            ({**PATHS, "type": "light_tracer"}, ["plain light paths", "connections to the camera"]),
            (best(PHOTONS), ["plain and guided light paths side by side",
                                                                      "volume photon points (a medium scatters), splatted"])]:
            scene = foggy(settings)
            lines = self.run_on(scene, "--explain").stdout.splitlines()
            said = self.plan(scene)["sampling"]
            self.assertEqual(lines[1:4], [f"  {name:10}{said[name]}" for name in ("paths", "vertices", "ends")])
            for part in parts:
                self.assertIn(part, " ".join(lines[1:4]))

    def test_pilots_tell_what_they_choose_where_they_are_quick(self):
        """And a render chooses the same."""
        for integrator, paths in (PATHS, "camera paths"), (PHOTONS, "light paths"):
            scene = foggy(best(integrator))
            said = re.search(f"  pilot     ([0-9.]+) of the {paths} are plain\n", self.run_on(scene, "--explain").stdout)
            file = Path(self.folder.name) / "stats.json"
            self.run_on(scene, "-d", self.folder.name, "--stats", str(file))
            self.assertEqual(round(1000 * float(said.group(1))), json.loads(file.read_text())["counters"][f"plain {paths}, in thousandths"])
        self.assertNotIn("  pilot  ", self.run_on(foggy(PATHS), "--explain").stdout)

    def test_what_is_left_out_is_told_with_them(self):
        late = foggy({**best(PATHS), "transient_time_center": 0.01, "transient_time_width": 0.01})
        self.assertIn("  left out  black image: no light can arrive", self.run_on(late, "--explain").stdout)

    def defaults(self, scene):
        return {taken["field"]: taken["value"] for taken in self.plan(scene)["defaults"]}

    def test_what_a_scene_leaves_open_is_said_with_its_value(self):
        bare = {"type": "progressive_transient_photon_map", "transient_time_center": 4, "transient_time_width": 4}
        found = self.defaults(foggy(bare))
        for field, value in {"integrator.max_bounces": "64", "integrator.photon_count": "1000000",
                             "integrator.volume_photon_count": "1000000", "integrator.gather_photon_count": "20",
                             "integrator.gather_radius": "unbounded", "integrator.volume_gather_radius": "gather_radius"}.items():
            self.assertEqual(found[field], value, field)
        self.assertFalse([field for field in found if field.startswith("renderer.")], "spp and spp_step are given")
        scene = foggy(bare)
        scene["renderer"] = {}
        self.assertEqual({field: value for field, value in self.defaults(scene).items() if field.startswith("renderer.")},
                         {"renderer.spp": "32", "renderer.spp_step": "16"})
        given = self.defaults(foggy({**bare, "max_bounces": 5, "photon_count": 7, "gather_radius": 0.1}))
        for field in ("max_bounces", "photon_count", "gather_radius"):
            self.assertNotIn(f"integrator.{field}", given)

    def test_a_radius_made_for_the_scene_is_said_with_its_reason(self):
        for kind in ({"volume_photon_type": "beams"}, {"fixed_volume_radius": True}):
            beams = {**PHOTONS, **kind}
            del beams["gather_radius"], beams["volume_gather_radius"]
            value = self.defaults(foggy(beams))["integrator.volume_gather_radius"]
            self.assertGreater(float(value.split(",")[0]), 0)
            self.assertIn("a hundredth of what the image spans", value)

    def test_what_an_image_lacks_is_said(self):
        laser = {"type": "directional_point", "emission": 1}
        self.assertIn("light of a single direction in view", self.plan(foggy(surface=laser))["lacks"][0])
        self.assertEqual(self.plan(room())["lacks"], [])


if __name__ == "__main__":
    unittest.main()
