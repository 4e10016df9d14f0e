"""addon/core is plain Python: it is loaded here without the add-on's own start, which needs Blender."""

import sys
import types
from pathlib import Path

ADDON = Path(__file__).resolve().parents[2] / "addon"

package = types.ModuleType("boucle_addon")
package.__path__ = [str(ADDON)]
sys.modules.setdefault("boucle_addon", package)
