"""Apply, save and delete presets."""

from __future__ import annotations

from bpy.app.translations import pgettext_data, pgettext_tip
from bpy.props import StringProperty
from bpy.types import Context, Operator, OperatorProperties

from .._identifiers import Operators
from ..bridge import presets
from ..core.refusal import Refusal
from .polling import has_cloth


class _OfPreset:
    """An operator on a preset."""

    preset: StringProperty(
        name="Preset", description="Name of the preset", default="", options={"SKIP_SAVE"}
    )

    @classmethod
    def poll(cls, context: Context) -> bool:
        """Only a cloth of this file."""
        return has_cloth(cls, context)

    def execute(self, context: Context) -> set[str]:
        """Do it, or report why it cannot be done."""
        try:
            self.act(context)
        except Refusal as refusal:
            self.report({"ERROR"}, str(refusal))
            return {"CANCELLED"}
        return {"FINISHED"}

    def act(self, context: Context) -> None:
        """What the operator does."""
        raise NotImplementedError


class BOUCLE_OT_apply_preset(_OfPreset, Operator):
    """Give the cloth the settings of this preset"""

    bl_idname = Operators.APPLY_PRESET
    bl_label = "Apply Preset"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def description(cls, _context: Context, properties: OperatorProperties) -> str:
        """What the preset says of itself, as the tooltip of its button."""
        return pgettext_tip(presets.description(properties.preset) or cls.__doc__)

    def act(self, context: Context) -> None:
        """Set the values."""
        presets.apply(context.object, self.preset)


class BOUCLE_OT_save_preset(_OfPreset, Operator):
    """Keep the model, the mass, the friction and the solver of this cloth as a preset"""

    bl_idname = Operators.SAVE_PRESET
    bl_label = "Save Preset"
    bl_options = {"REGISTER", "INTERNAL"}

    def act(self, context: Context) -> None:
        """Write the file; the field is ready for the next name."""
        name = presets.save(context.object, self.preset)
        manager = context.window_manager
        if manager is not None and manager.preset_name.strip() == name:
            manager.preset_name = pgettext_data("New Preset")


class BOUCLE_OT_delete_preset(_OfPreset, Operator):
    """Delete this preset from the disk"""

    bl_idname = Operators.DELETE_PRESET
    bl_label = "Delete Preset"
    bl_options = {"REGISTER", "INTERNAL"}

    def act(self, _context: Context) -> None:
        """Remove the file."""
        presets.delete(self.preset)


CLASSES = (BOUCLE_OT_apply_preset, BOUCLE_OT_save_preset, BOUCLE_OT_delete_preset)
