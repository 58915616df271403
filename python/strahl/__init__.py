"""Exact, explainable, reproducible ray tracing.

Scenes come from files (`load`), texts (`parse`) or objects (`Scene`). A scene renders pictures (`Scene.render`), answers questions about rays
(`Scene.intersect`, `Scene.occluded`, `Scene.inside`) and explains pixels (`Scene.explain`).

Vectors are tuples, lists or arrays of three numbers. Colours are linear: three numbers, one for a grey, or sRGB as ``"#rrggbb"``. Angles are in
degrees. Positions are in the units of the scene; y is up in cameras unless `up` says otherwise.
"""

from strahl import _tree as tree
from strahl._air import Fog, Rainbow
from strahl._arrays import from_ase, from_trimesh, height_field, isosurface, mesh, spheres
from strahl._cameras import Camera
from strahl._costs import Comparison, HeatMap
from strahl._errors import Diagnostic, InternalError, SceneError, SceneWarning
from strahl._film import Film
from strahl._fractals import implicit, julia, mandelbulb, menger, parametric, terrain, text
from strahl._lights import (
    area_light,
    beam_light,
    directional_light,
    Light,
    parallel_light,
    point_light,
    spot_light,
)
from strahl._load import load, parse
from strahl._looks import Background, Material
from strahl._objects import difference, intersection, light_group, merge, Object, union
from strahl._patches import bicubic_patch, brep, nurbs, NurbsCurve, subdivision
from strahl._patterns import Pattern
from strahl._progress import Progress
from strahl._rays import Hits
from strahl._scene import Scene
from strahl._shapes import (
    blob,
    box,
    cone,
    cylinder,
    disc,
    lathe,
    lemon,
    ovus,
    plane,
    polygon,
    polynomial,
    pov,
    prism,
    quadric,
    sor,
    sphere,
    sphere_sweep,
    superellipsoid,
    torus,
    triangle,
)
from strahl._strahl import __version__, thread_count
from strahl._textures import Finish, Interior, Normal, Pigment, Texture
from strahl._tree import Explanation

__all__ = [
    "Background",
    "Camera",
    "Comparison",
    "Diagnostic",
    "Explanation",
    "Film",
    "Finish",
    "Fog",
    "HeatMap",
    "Hits",
    "Interior",
    "InternalError",
    "Light",
    "Material",
    "Normal",
    "NurbsCurve",
    "Object",
    "Pattern",
    "Pigment",
    "Progress",
    "Rainbow",
    "Scene",
    "SceneError",
    "SceneWarning",
    "Texture",
    "__version__",
    "area_light",
    "beam_light",
    "bicubic_patch",
    "blob",
    "box",
    "brep",
    "cone",
    "cylinder",
    "difference",
    "directional_light",
    "disc",
    "from_ase",
    "from_trimesh",
    "height_field",
    "implicit",
    "intersection",
    "isosurface",
    "julia",
    "lathe",
    "lemon",
    "light_group",
    "load",
    "mandelbulb",
    "menger",
    "merge",
    "mesh",
    "nurbs",
    "ovus",
    "parallel_light",
    "parametric",
    "parse",
    "plane",
    "point_light",
    "polygon",
    "polynomial",
    "pov",
    "prism",
    "quadric",
    "sor",
    "sphere",
    "sphere_sweep",
    "spheres",
    "spot_light",
    "subdivision",
    "superellipsoid",
    "terrain",
    "text",
    "thread_count",
    "torus",
    "tree",
    "triangle",
    "union",
]
