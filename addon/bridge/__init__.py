"""Between Blender's data and arrays: sampling, modifiers, live frames and bakes."""
