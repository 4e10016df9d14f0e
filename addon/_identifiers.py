"""Names that Blender, files and scripts know; each stands here once."""


class Operators:
    """Operator names, as `bpy.ops` has them."""

    ADD_CLOTH = "boucle.add_cloth"
    ADD_FLAG = "boucle.add_flag"
    ADD_CURTAIN = "boucle.add_curtain"
    ADD_CAPE = "boucle.add_cape"
    ADD_TABLECLOTH = "boucle.add_tablecloth"
    DRAPE = "boucle.drape"
    ENABLE = "boucle.enable"
    DISABLE = "boucle.disable"
    BAKE = "boucle.bake"
    BAKE_ALL = "boucle.bake_all"
    FREE_BAKE = "boucle.free_bake"
    RESTORE_BAKE = "boucle.restore_bake"
    ADOPT_BAKE = "boucle.adopt_bake"
    EXPORT_USD = "boucle.export_usd"
    EXPORT_ALEMBIC = "boucle.export_alembic"
    RESET = "boucle.reset"
    GRAB = "boucle.grab"
    CHECK = "boucle.check"
    ADD_WELD = "boucle.add_weld"
    ADD_MATERIAL = "boucle.add_material"
    ADD_HEAT_MAP_MATERIAL = "boucle.add_heat_map_material"
    APPLY_PRESET = "boucle.apply_preset"
    SAVE_PRESET = "boucle.save_preset"
    DELETE_PRESET = "boucle.delete_preset"
    COPY_FROM_CLOTH = "boucle.copy_from_cloth"
    SELECT_PROBLEM = "boucle.select_problem"
    MAKE_COLLIDER = "boucle.make_collider"
    GO_TO_WORST_FRAME = "boucle.go_to_worst_frame"
    SELECT_WORST_EDGES = "boucle.select_worst_edges"
    ADD_PROXY = "boucle.add_proxy"
    DRIVE_WITH_PROXY = "boucle.drive_with_proxy"
    ADD_TAKE = "boucle.add_take"
    RESTORE_TAKE = "boucle.restore_take"
    REMOVE_TAKE = "boucle.remove_take"
    COMPARE_TAKE = "boucle.compare_take"
    APPLY_AS_REST = "boucle.apply_as_rest"
    APPLY_AS_START = "boucle.apply_as_start"
    APPLY_AS_SHAPE_KEY = "boucle.apply_as_shape_key"


class Lists:
    """Names of lists in panels."""

    TAKES = "BOUCLE_UL_takes"


class Menus:
    """Menu names."""

    ADD = "BOUCLE_MT_add"
    PRESETS = "BOUCLE_MT_presets"


class Panels:
    """Panel names."""

    CLOTH = "BOUCLE_PT_cloth"
    PRESETS = "BOUCLE_PT_presets"
    PROBLEMS = "BOUCLE_PT_problems"
    SPRINGS = "BOUCLE_PT_springs"
    STIFFNESS = "BOUCLE_PT_stiffness"
    DAMPING = "BOUCLE_PT_damping"
    DEFORMATION = "BOUCLE_PT_deformation"
    FABRIC = "BOUCLE_PT_fabric"
    FABRIC_STIFFNESS = "BOUCLE_PT_fabric_stiffness"
    FABRIC_BENDING = "BOUCLE_PT_fabric_bending"
    FABRIC_DAMPING = "BOUCLE_PT_fabric_damping"
    FABRIC_DEFORMATION = "BOUCLE_PT_fabric_deformation"
    SHAPE = "BOUCLE_PT_shape"
    REST_SHAPE = "BOUCLE_PT_rest_shape"
    PRESSURE = "BOUCLE_PT_pressure"
    SEWING = "BOUCLE_PT_sewing"
    COLLISIONS = "BOUCLE_PT_collisions"
    TEARING = "BOUCLE_PT_tearing"
    OBJECT_COLLISIONS = "BOUCLE_PT_object_collisions"
    SELF_COLLISIONS = "BOUCLE_PT_self_collisions"
    FORCES = "BOUCLE_PT_forces"
    WATER = "BOUCLE_PT_water"
    FIELD_WEIGHTS = "BOUCLE_PT_field_weights"
    SOLVER = "BOUCLE_PT_solver"
    SOLVER_ADVANCED = "BOUCLE_PT_solver_advanced"
    CACHE = "BOUCLE_PT_cache"
    LOOK = "BOUCLE_PT_look"
    OVERLAY = "BOUCLE_PT_overlay"
    RESULT = "BOUCLE_PT_result"
    TAKES = "BOUCLE_PT_takes"


class PanelOrder:
    """Where each panel stands among its siblings (`bl_order`), whatever was registered first; gaps are for new ones."""

    # below Boucle Cloth
    PROBLEMS = 5
    SPRINGS = 10
    FABRIC = 11
    SHAPE = 20
    COLLISIONS = 30
    TEARING = 40
    FORCES = 50
    SOLVER = 60
    CACHE = 70
    LOOK = 80
    OVERLAY = 90
    # below Springs and Fabric
    STIFFNESS = 10
    BENDING = 15
    DAMPING = 20
    DEFORMATION = 30
    # below Shape
    SEWING = 20
    REST_SHAPE = 30
    SHRINK = 40
    PRESSURE = 50
    # below Collisions
    OBJECT_COLLISIONS = 10
    SELF_COLLISIONS = 20
    # below Forces
    WATER = 5
    FIELD_WEIGHTS = 10
    # below Cache
    RESULT = 10
    TAKES = 20
    # below Solver
    SOLVER_ADVANCED = 90


EXTENSION = "boucle"
POINTER = "boucle"
"""Name of the settings on every object: `object.boucle`."""

TARGET_ATTRIBUTE = "boucle_target"
"""Point attribute: where the modifiers above the slot put each vertex (m, object space)."""
REST_ATTRIBUTE = "boucle_rest"
"""Point attribute: the rest shape (m, object space), there only while `position` shows a frame."""

STRAIN_ATTRIBUTE = "boucle_strain"
"""Point attribute: the largest strain of the edges at each vertex in the frame that is shown."""

TENSION_ATTRIBUTE = "boucle_tension"
"""Point attribute: the largest tension (N) of the springs at each vertex in the frame that is shown."""

CONTACT_ATTRIBUTE = "boucle_contact"
"""Point attribute: the force (N) with which contacts press on each vertex in the frame that is shown."""

INTERSECTION_ATTRIBUTE = "boucle_intersection"
"""Point attribute: in how many intersections each vertex takes part in the frame that is shown."""

FORCE_ATTRIBUTE = "boucle_force"
"""Face corner attribute: the force (N) in the edge from each corner to the next in the frame that is shown."""

TEAR_ATTRIBUTE = "boucle_tear"
"""Edge attribute: which edges the bake that is played tears."""
ORIGIN_ATTRIBUTE = "boucle_origin"
"""Point attribute between split and mend: 1 + the vertex from which a point was split; 0 for the others."""

REST_COUNT = "boucle_rest_count"
"""Custom property of a mesh beside that attribute: how many vertices it had when the rest shape was kept."""

TARGET_MODIFIER = "Boucle Target"
CACHE_MODIFIER = "Boucle Cache"
WELD_MODIFIER = "Boucle Weld"
TEAR_MODIFIER = "Boucle Tear"
MEND_MODIFIER = "Boucle Mend"
TARGET_GROUP = "Boucle Target"
TEAR_GROUP = "Boucle Tear"
SPLIT_GROUP = "Boucle Split"
MEND_GROUP = "Boucle Mend"
FABRIC_MARK = "boucle_fabric"
"""Custom property of our shader groups: the fabric that they are."""
TARGET_GROUP_MARK = "boucle_target_group"
"""Custom property that tells our node group from a stranger's of the same name."""
TEAR_GROUP_MARK = "boucle_tear_group"
"""The same of the groups that split edges, "torn" or "all" of them, and of that which mends, "mend"."""
TEAR_GROUP_DIGEST = "boucle_tear_nodes"
"""Custom property of those: a digest of their nodes as they were made."""

CACHE_FOLDER = "boucle_cache"
PICTURE_FOLDER = "boucle_pictures"
LIVE_FOLDER = "boucle_live"
