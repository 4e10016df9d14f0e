"""The panels as a tree: Blender's words, in Blender's order, closed where Blender's own cloth is."""

ORDER = {
    "BOUCLE_PT_cloth": [
        "Springs",
        "Fabric",
        "Shape",
        "Collisions",
        "Tearing",
        "Forces",
        "Solver",
        "Cache",
    ],
    "BOUCLE_PT_springs": ["Stiffness (N/m)", "Damping (N·s/m)", "Deformation"],
    "BOUCLE_PT_fabric": ["Stiffness (N/m)", "Bending (µN·m)", "Damping", "Deformation"],
    "BOUCLE_PT_collisions": ["Object Collisions", "Self Collisions"],
}
CLOSED = {"Shape", "Collisions", "Tearing", "Forces", "Cache", "Advanced"}


def look_at_the_panels():
    import bpy

    kinds = [getattr(bpy.types, n) for n in dir(bpy.types) if n.startswith("BOUCLE_PT_")]
    return [
        {
            "id": kind.bl_idname,
            "parent": getattr(kind, "bl_parent_id", ""),
            "label": kind.bl_label,
            "order": getattr(kind, "bl_order", 0),
            "closed": "DEFAULT_CLOSED" in getattr(kind, "bl_options", set()),
        }
        for kind in kinds
    ]


def test_panels_stand_in_their_order_whatever_is_registered_first(new_blender):
    panels = new_blender.run(look_at_the_panels)
    children = [panel for panel in panels if panel["parent"]]
    assert [p["id"] for p in children if not p["order"]] == [], "without bl_order: it stands first"
    for parent, labels in ORDER.items():
        rows = sorted((p["order"], p["label"]) for p in children if p["parent"] == parent)
        assert [label for _, label in rows if label in labels] == labels
        orders = [order for order, _ in rows]
        assert len(set(orders)) == len(orders), f"two panels stand at the same place: {rows}"
    closed = {panel["label"] for panel in children if panel["closed"]}
    assert closed >= CLOSED
    assert not closed & {
        "Springs",
        "Fabric",
        "Stiffness (N/m)",
        "Damping (N·s/m)",
        "Object Collisions",
        "Self Collisions",
    }
