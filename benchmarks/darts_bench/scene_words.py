"""Words to write small scenes with: transforms, media, bodies, lights, cameras, gates. Every transform is a 4x4 matrix, so
that copies of a scene can be scaled, turned and moved."""

from dataclasses import dataclass, field

import numpy as np

from darts_bench.images import write_pfm

SIDE = 16  # pixels


@dataclass(frozen=True)
class SweepScene:
    """A scene file in parts, its kernel radius, and how it is to be rendered."""
    name: str
    shows: str
    media: list
    primitives: list
    camera: dict
    integrator: dict
    radius: float
    effort: dict = field(default_factory=dict)   # factor on samples or photons by method
    without: dict = field(default_factory=dict)  # methods left out, and why
    renderer: dict = field(default_factory=dict)  # fields of the renderer block
    unit: float = 1.0                            # length of what is 1 in the unscaled scene
    blurred: tuple = ()                          # primitives that see it through a kernel; none named: all

    @property
    def steady(self):
        return not ("transient_time_width" in self.integrator or "temporal_response" in self.integrator)


# ---- Transforms

def _matrix(rotation=None, offset=(0.0, 0.0, 0.0)):
    result = np.eye(4)
    if rotation is not None:
        result[:3, :3] = rotation
    result[:3, 3] = offset
    return result


def rotation_about(axis, degrees):
    """Right-handed rotation matrix (Rodrigues)."""
    x, y, z = np.asarray(axis, float) / np.linalg.norm(axis)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    angle = np.radians(degrees)
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def at(x, y, z, scale=1.0, turn=0.0, about=(0, 1, 0)):
    """Scaled (a number or three), then turned by degrees about an axis, then moved to a place."""
    return _matrix(rotation_about(about, turn) @ np.diag(np.broadcast_to(np.asarray(scale, float), 3)), (x, y, z))


def looking(position, target, up=(0.0, 1.0, 0.0)):
    """+z towards the target; right-handed."""
    z = np.subtract(target, position).astype(float)
    z /= np.linalg.norm(z)
    x = np.cross(up, z)
    x /= np.linalg.norm(x)
    return _matrix(np.column_stack([x, np.cross(z, x), z]), position)


def facing(position, target, size):
    """A quad's or disk's transform whose front (+y) faces the target."""
    y = np.subtract(target, position).astype(float)
    y /= np.linalg.norm(y)
    x = np.cross(y, (0.0, 0.0, 1.0) if abs(y[2]) < 0.9 else (1.0, 0.0, 0.0))
    x /= np.linalg.norm(x)
    return _matrix(np.column_stack([x, y, np.cross(x, y)]) * size, position)


# ---- Materials and media

FORWARD, BLACK = {"type": "forward"}, {"type": "null"}


def lambert(albedo=0.6, **fields):
    return {"type": "lambert", "albedo": albedo, **fields}


def medium(name, sigma_s, sigma_a=0.0, g=0.0, speed=1.0, **fields):
    phase = {"type": "henyey_greenstein", "g": g} if g else {"type": "isotropic"}
    return {"name": name, "type": "homogeneous", "sigma_s": sigma_s, "sigma_a": sigma_a, "speed_of_light": speed,
            "phase_function": phase, **fields}


# ---- Bodies and lights

def body(shape, transform, inside=None, outside=None, bsdf=None, **fields):
    """A surface; index-matched if no material is given."""
    media = {key: value for key, value in (("int_medium", inside), ("ext_medium", outside)) if value}
    return {"type": shape, "transform": transform, "bsdf": bsdf or FORWARD, **media, **fields}


def lamp(shape, transform, emission, outside=None, **fields):
    """A light whose surface, if it has one, is black."""
    surface = {} if shape in ("point", "spot", "collimated", "directional_point", "infinite_sphere") else {"bsdf": BLACK}
    medium_around = {"ext_medium": outside} if outside else {}
    return {"type": shape, "transform": transform, "emission": emission, **surface, **medium_around, **fields}


def room(side, albedo=0.5, outside=None, height=None, centre=(0.0, 0.0, 0.0), **bsdf):
    """Floor, ceiling and back wall: quads that face inwards, ext_medium on the inner side."""
    half, top = side / 2, (height or side) / 2
    walls = [((0, -top, 0), (0, 0, 0)), ((0, top, 0), (0, 0, 0)), ((0, 0, -half), (0, 0, 0))]
    return [body("quad", facing(np.add(place, centre), np.add(target, centre), side), outside=outside,
                 bsdf=lambert(albedo, **bsdf)) for place, target in walls]


# ---- Cameras and integrators

def camera(position=(0, 0, 5), target=(0, 0, 0), fov=20.0, inside=None, kind="pinhole", **fields):
    lens = {} if kind == "orthographic" else {"fov": fov}
    return {"type": kind, "resolution": [SIDE, SIDE], "reconstruction_filter": "box", "transform": looking(position, target),
            **lens, **({"medium": inside} if inside else {}), **fields}


def gate(start, end, bounces=32, **fields):
    return {"max_bounces": bounces, "vaccum_speed_of_light": 1.0, "transient_time_center": (start + end) / 2,
            "transient_time_width": end - start, **fields}


def frames(start, width, count, bounces=32, **fields):
    return {"max_bounces": bounces, "vaccum_speed_of_light": 1.0, "start_time": start, "transient_time_width": width,
            "frame_num": count, **fields}


def steady(bounces=32, **fields):
    return {"max_bounces": bounces, "vaccum_speed_of_light": 1.0, **fields}


# ---- Files that scenes refer to

def write_assets(folder):
    """A ball of triangles with smooth normals, a bump map of waves, a mask of stripes."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "ball.obj").write_text(ball(6, 10))
    y, x = np.mgrid[0:16, 0:16] / 16.0
    for name, grey in (("waves", 0.5 + 0.5 * np.sin(2 * np.pi * x) * np.sin(4 * np.pi * y)), ("stripes", np.where(x < 0.5, 1.0, 0.2))):
        write_pfm(folder / f"{name}.pfm", np.repeat(grey[:, :, None], 3, axis=2))


def ball(rings, segments):
    """A sphere of radius 1 about the origin as OBJ: 2 segments (rings - 1) triangles, their front faces outwards."""
    points, faces = [(0.0, 0.0, 1.0)], []
    for ring in range(1, rings):
        theta = np.pi * ring / rings
        for phi in 2 * np.pi * np.arange(segments) / segments:
            points.append((np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)))
    points.append((0.0, 0.0, -1.0))
    last = len(points)
    for i in range(segments):
        j = (i + 1) % segments
        faces.append((1, 2 + i, 2 + j))
        for ring in range(rings - 2):
            a, b = 2 + ring * segments, 2 + (ring + 1) * segments
            faces += [(a + i, b + i, b + j), (a + i, b + j, a + j)]
        base = 2 + (rings - 2) * segments
        faces.append((base + i, last, base + j))
    lines = [f"v {x:.7f} {y:.7f} {z:.7f}\nvn {x:.7f} {y:.7f} {z:.7f}" for x, y, z in points]
    return "\n".join(lines + ["f " + " ".join(f"{v}//{v}" for v in face) for face in faces]) + "\n"
