"""What MkDocs calls while it builds the site (tools/docs.sh): anchors of headings are those of check_links.py."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
from check_links import slug  # noqa: E402


def on_config(config):
    config["mdx_configs"].setdefault("toc", {})["slugify"] = slug
    config["mdx_configs"]["toc"]["permalink"] = True
    return config
