"""Install an extension zip in the embedded Blender, use it once, take it away: `try_extension.py ZIP`.

BLENDER_USER_RESOURCES must name a folder of its own. Exit code 0 if all went well.
"""

from __future__ import annotations

import os
import sys
import traceback
from pathlib import Path

FRAMES = 3


def main(file: str) -> None:
    """Install, add a cloth, bake, check that it moved, disable."""
    import bpy

    installed = bpy.ops.extensions.package_install_files(
        filepath=file, repo="user_default", enable_on_install=True
    )
    assert installed == {"FINISHED"}, installed
    module = "bl_ext.user_default.boucle"
    assert module in bpy.context.preferences.addons, "the extension is not enabled"

    import boucle_core

    home = Path(os.environ["BLENDER_USER_RESOURCES"]).resolve()
    assert home in Path(boucle_core.__file__).resolve().parents, boucle_core.__file__

    assert bpy.ops.boucle.add_cloth(vertices_x=9, vertices_y=9) == {"FINISHED"}
    cloth = bpy.context.object
    cloth.boucle.frame_start, cloth.boucle.frame_end = 1, FRAMES
    assert bpy.ops.boucle.bake() == {"FINISHED"}
    bpy.context.scene.frame_set(FRAMES)
    evaluated = cloth.evaluated_get(bpy.context.evaluated_depsgraph_get())
    moved = max(
        (a.co - b.co).length
        for a, b in zip(evaluated.data.vertices, cloth.data.vertices, strict=True)
    )
    assert moved > 1e-4, f"the baked cloth moved by {moved} m"
    bpy.ops.preferences.addon_disable(module=module)
    version = bpy.app.version_string
    print(f"   Blender {version}: installed, enabled, baked {FRAMES} frames, moved {moved:.4f} m")


if __name__ == "__main__":
    try:
        main(sys.argv[1])
    except BaseException:  # noqa: BLE001 (told in full; the exit code says it too)
        traceback.print_exc()
        sys.stderr.flush()
        os._exit(1)
    sys.stdout.flush()
    os._exit(0)
