"""Scenes that tests in Python share."""


def lamp_over_floor(resolution, integrator, renderer):
    """A lamp in fog over a grey floor; `integrator` and `renderer` are the scene's blocks."""
    return {
        "media": [{"name": "fog", "type": "homogeneous", "sigma_s": 0.8, "sigma_a": 0.05}],
        "bsdfs": [{"name": "grey", "type": "lambert", "albedo": 0.6}],
        "primitives": [
            {"name": "floor", "type": "quad", "bsdf": "grey", "transform": {"scale": [4, 1, 4]}},
            {"name": "lamp", "type": "point", "ext_medium": "fog", "emission": 8,
             "transform": {"position": [0.5, 1.8, 1]}}],
        "camera": {"type": "pinhole", "resolution": list(resolution), "fov": 45, "medium": "fog",
                   "transform": {"position": [0, 1.2, 3.5], "look_at": [0, 0.5, 0], "up": [0, 1, 0]}},
        "integrator": integrator, "renderer": renderer}
