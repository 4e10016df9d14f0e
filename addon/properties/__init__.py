"""The settings of a cloth: `object.boucle`, with the scene file's words."""
