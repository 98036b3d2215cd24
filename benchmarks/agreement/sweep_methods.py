"""What a sweep renders its scenes with."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Method:
    name: str
    settings: dict
    samples: int     # per pixel of a path tracer, passes of a photon map
    photons: int = 0  # light paths per pass; 0: not a photon map

    @property
    def guided(self):
        return self.settings["darts"] != "off"

    @property
    def primitive(self):
        return self.settings.get("volume_photon_type")

    @property
    def sliced(self):
        return self.primitive not in (None, "points", "beams")

    def blurs(self, scene):
        """Whether a kernel's radius counts."""
        return self.photons > 0 and (not scene.blurred or self.primitive in scene.blurred)

    @property
    def steady(self):
        """Whether it can do without a gate, where there is nothing to guide light paths to."""
        return not self.guided and (not self.sliced or self.primitive in ("planes", "volumes"))


def photon_method(name, primitive, darts, passes, photons):
    settings = {"type": "photons", "volume_photon_type": primitive, "darts": darts, "alpha": 1.0, "volume_alpha": 1.0,
                "fixed_volume_radius": True, "gather_photon_count": 1000000, "volume_photon_count": 100000000}
    return Method(name, settings, passes, photons)


METHODS = [
    Method("plain paths", {"type": "path_tracer", "darts": "off"}, 512),
    Method("best paths", {"type": "path_tracer", "darts": "best"}, 96),
    photon_method("plain points", "points", "off", 4, 50000),
    photon_method("best points", "points", "best", 4, 6000),
    photon_method("plain beams", "beams", "off", 4, 12000),
    photon_method("best beams", "beams", "best", 4, 3000),
]

# Sliced primitives, and what they are held against: camera paths and beams. volumes_balls are what volumes are at a gate.
SLICE_METHODS = [
    Method("plain paths", {"type": "path_tracer", "darts": "off"}, 192),
    Method("best paths", {"type": "path_tracer", "darts": "best"}, 32),
    photon_method("best beams", "beams", "best", 4, 2500),
    *[photon_method(f"{prefix} {kind}", kind, darts, 4, count) for kind in
      ("planes", "volumes", "balls", "mis_volumes_balls", "hypervolumes")
      for prefix, darts, count in (("plain", "off", 1500), ("best", "best", 400))],
]
