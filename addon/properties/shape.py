"""Mass and pins."""

from bpy.props import EnumProperty, FloatProperty, StringProperty

from .changes import FIXED, OVERRIDABLE, changed


class ShapeProperties:
    """Settings of what the cloth weighs and where it is held."""

    in_presets = ("mass_mode", "density", "mass_per_vertex")

    mass_mode: EnumProperty(
        name="Mass",
        description="How the mass is given. By Area stays right when you refine the mesh; Per Vertex is that of the "
        "papers",
        items=(
            ("density", "By Area", "Mass of a square metre of cloth"),
            ("vertex", "Per Vertex", "Mass of every vertex"),
        ),
        default="density", options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    density: FloatProperty(
        name="Density",
        description="Areal density (kg/m²): chiffon 0.03, shirting 0.12, denim 0.4. More hangs straighter, stretches "
        "further and gives way less to the wind",
        default=0.2, min=1e-6, max=1e6, soft_min=0.01, soft_max=5.0, precision=3, step=1,
        override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    mass_per_vertex: FloatProperty(
        name="Mass per Vertex",
        description="Mass of every vertex (kg). On a finer mesh the cloth is heavier; By Area is not",
        default=0.1, min=1e-9, max=1e6, soft_min=1e-4, soft_max=1.0, precision=5, step=1,
        override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    pin_group: StringProperty(
        name="Pin Group",
        description="Vertex group whose vertices are held: they follow the object and its armature. Weight 1 holds "
        "firmly, less draws the vertex to its place like a spring, 0 leaves it free",
        default="", options=FIXED, override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    pin_strength: FloatProperty(
        name="Strength",
        description="Part of the painted weights that counts (fraction): 1 as painted, 0 lets all pins go. "
        "Keyframes and drivers weaken or release pins with it",
        default=1.0, min=0.0, max=1.0, subtype="FACTOR",
        override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    pin_stiffness: FloatProperty(
        name="Stiffness",
        description="Stiffness (N/m) that draws pins of less than full weight to their places: of all that edges join "
        "to a patch together, so that it holds alike however fine the mesh is",
        default=1000.0, min=0.0, max=1e9, soft_max=1e5, precision=1, step=100,
        override=OVERRIDABLE, update=changed,
    )  # fmt: skip
    pin_damping: FloatProperty(
        name="Damping",
        description="Damping of those pins (ratio to critical): from 1 on a pin alone comes to rest without swinging",
        default=1.0, min=0.0, max=1e3, soft_max=10.0, precision=2, step=10,
        override=OVERRIDABLE, update=changed,
    )  # fmt: skip
