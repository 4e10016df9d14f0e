"""Names that Blender, files and scripts know; each stands here once."""


class Operators:
    """Operator names, as `bpy.ops` has them."""

    ADD_CLOTH = "boucle.add_cloth"
    ENABLE = "boucle.enable"
    DISABLE = "boucle.disable"
    BAKE = "boucle.bake"
    BAKE_ALL = "boucle.bake_all"
    FREE_BAKE = "boucle.free_bake"
    RESTORE_BAKE = "boucle.restore_bake"
    ADOPT_BAKE = "boucle.adopt_bake"
    RESET = "boucle.reset"
    CHECK = "boucle.check"
    ADD_WELD = "boucle.add_weld"


class Panels:
    """Panel names."""

    CLOTH = "BOUCLE_PT_cloth"
    SPRINGS = "BOUCLE_PT_springs"
    DAMPING = "BOUCLE_PT_damping"
    DEFORMATION = "BOUCLE_PT_deformation"
    SHAPE = "BOUCLE_PT_shape"
    REST_SHAPE = "BOUCLE_PT_rest_shape"
    PRESSURE = "BOUCLE_PT_pressure"
    SEWING = "BOUCLE_PT_sewing"
    COLLISIONS = "BOUCLE_PT_collisions"
    OBJECT_COLLISIONS = "BOUCLE_PT_object_collisions"
    SELF_COLLISIONS = "BOUCLE_PT_self_collisions"
    FORCES = "BOUCLE_PT_forces"
    SOLVER = "BOUCLE_PT_solver"
    SOLVER_ADVANCED = "BOUCLE_PT_solver_advanced"
    CACHE = "BOUCLE_PT_cache"


EXTENSION = "boucle"
POINTER = "boucle"
"""Name of the settings on every object: `object.boucle`."""

TARGET_ATTRIBUTE = "boucle_target"
"""Point attribute: where the modifiers above the slot put each vertex (m, object space)."""
REST_ATTRIBUTE = "boucle_rest"
"""Point attribute: the rest shape (m, object space), there only while `position` shows a frame."""

STRAIN_ATTRIBUTE = "boucle_strain"
"""Point attribute: the largest strain of the edges at each vertex in the frame that is shown."""

CONTACT_ATTRIBUTE = "boucle_contact"
"""Point attribute: the force (N) with which contacts press on each vertex in the frame that is shown."""

INTERSECTION_ATTRIBUTE = "boucle_intersection"
"""Point attribute: in how many intersections each vertex takes part in the frame that is shown."""

REST_COUNT = "boucle_rest_count"
"""Custom property of a mesh beside that attribute: how many vertices it had when the rest shape was kept."""

TARGET_MODIFIER = "Boucle Target"
CACHE_MODIFIER = "Boucle Cache"
WELD_MODIFIER = "Boucle Weld"
TARGET_GROUP = "Boucle Target"
TARGET_GROUP_MARK = "boucle_target_group"
"""Custom property that tells our node group from a stranger's of the same name."""

CACHE_FOLDER = "boucle_cache"
LIVE_FOLDER = "boucle_live"
