"""Runs one function of a test file in a Blender process of its own; started by conftest.py.

Usage: python child.py TEST_FILE FUNCTION ADDON(0|1) ARGUMENTS_JSON RESULT_FILE
"""

import importlib.util
import json
import os
import sys
import traceback
from pathlib import Path


def load(path):
    """The test file as a module; it must not need pytest at import."""
    spec = importlib.util.spec_from_file_location(Path(path).stem, path)
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


def main():
    """Enable the extension, call the function and write what it returns."""
    path, function, with_addon, arguments, result = sys.argv[1:]
    import bpy

    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    if with_addon == "1":
        import addon_utils

        module = "bl_ext.user_default.boucle"
        assert addon_utils.enable(module, default_set=True, persistent=True), "not enabled"
    sys.path.insert(0, str(Path(__file__).parent))
    value = getattr(load(path), function)(**json.loads(arguments))
    Path(result).write_text(json.dumps(value))


try:
    main()
except BaseException:  # noqa: BLE001 (the parent reads the traceback and the exit code)
    traceback.print_exc()
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(1)
sys.stdout.flush()
sys.stderr.flush()
os._exit(0)
