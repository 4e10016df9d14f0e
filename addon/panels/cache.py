"""Frame range, bake and what became of it."""

from __future__ import annotations

from bpy.types import Context, Panel

from .._identifiers import Operators, PanelOrder, Panels
from .cloth import PhysicsPanel, draw_text


class BOUCLE_PT_cache(PhysicsPanel, Panel):
    """The result, in memory or on disk"""

    bl_idname = Panels.CACHE
    bl_parent_id = Panels.CLOTH
    bl_label = "Cache"
    bl_order = PanelOrder.CACHE
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: Context) -> None:
        """Lay out."""
        settings = context.object.boucle
        column = self.column()
        column.prop(settings, "frame_start")
        column.prop(settings, "frame_end")
        column.prop(settings, "settle_frames")
        damped = column.column()
        damped.active = settings.settle_frames > 0
        damped.prop(settings, "settle_damped")
        column.prop(settings, "use_live")
        for name in ("use_strain", "use_tension", "use_force", "use_contact", "use_intersection"):
            column.prop(settings, name)
        layout = self.layout
        layout.operator(Operators.BAKE).resume = False
        row = layout.row(align=True)
        row.operator(Operators.BAKE, text="Resume").resume = True
        row.operator(Operators.BAKE_ALL).resume = False
        row = layout.row(align=True)
        if settings.is_baked:
            row.operator(Operators.FREE_BAKE)
        else:
            row.operator(Operators.RESET)
        if settings.has_previous:
            row.operator(Operators.RESTORE_BAKE)
        if settings.is_foreign:
            layout.operator(Operators.ADOPT_BAKE)
        if settings.is_baked:
            row = layout.row(align=True)
            row.operator(Operators.EXPORT_USD)
            row.operator(Operators.EXPORT_ALEMBIC)
        layout.operator(Operators.GRAB, icon="VIEW_PAN")
        for line in settings.status.split("; "):
            draw_text(layout, line, context)
        if settings.certificate:
            draw_text(layout, settings.certificate, context, icon="INFO")
        if settings.warning:
            draw_text(layout, settings.warning, context, icon="ERROR")


CLASSES = (BOUCLE_PT_cache,)
