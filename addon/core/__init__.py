"""What the add-on knows without Blender: nothing below imports bpy."""
