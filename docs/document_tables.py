"""Write the field tables of docs/document.md: ``python docs/document_tables.py``."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from phantom.document import LEAVES, OPERATORS, Document
from phantom.document.leaf import LeafModel

PAGE = Path(__file__).parent / "document.md"
START = "<!-- field tables: made by docs/document_tables.py -->\n"
FIRST = (
    "Document",
    "FixedMaterial",
    "ReferenceMaterial",
    "CompositionMaterial",
    "Transformed",
    "Instance",
)


def shape(schema: dict[str, Any]) -> str:
    """Say the shape of a value in a few characters."""
    if "$ref" in schema:
        return schema["$ref"].rsplit("/", 1)[1]
    for union in ("anyOf", "oneOf"):
        if union in schema:
            parts = dict.fromkeys(shape(part) for part in schema[union])
            parts.pop("null", None)
            names = list(parts)
            if len(names) > 10:
                return "a solid"
            return " or ".join(names)
    if "enum" in schema:
        return "a reference name" if len(schema["enum"]) > 5 else " or ".join(schema["enum"])
    if "const" in schema:
        return f"`{schema['const']}`"
    if "prefixItems" in schema:
        items = [shape(item) for item in schema["prefixItems"]]
        alike = f"{len(items)} × {items[0]}" if len(set(items)) == 1 else ", ".join(items)
        return f"[{alike}]"
    if schema.get("type") == "array":
        return f"[{shape(schema['items'])}, …]"
    if schema.get("type") == "object":
        inner = schema.get("additionalProperties")
        return f"name → {shape(inner)}" if isinstance(inner, dict) else "object"
    return str(schema.get("type", "any"))


def limits(schema: dict[str, Any]) -> str:
    """Say the limits of a number or an array, where there are any."""
    for part in (schema, *schema.get("anyOf", ())):
        words = [
            f"{sign} {part[key]:g}"
            for key, sign in (
                ("exclusiveMinimum", ">"),
                ("minimum", "≥"),
                ("maximum", "≤"),
                ("minItems", "at least"),
            )
            if key in part and "prefixItems" not in part and abs(part[key]) < 1e18
        ]
        if words:
            return ", " + ", ".join(words)
    return ""


def table(head: str, about: str, schema: dict[str, Any], left_out: frozenset[str]) -> str:
    """Return one model's table; a field in bold must be given."""
    text = f"### {head}\n\n{about}\n\n"
    text += "| field | value | unit | meaning |\n|---|---|---|---|\n"
    for name, field in schema["properties"].items():
        if name in left_out:
            continue
        mark = "**" if name in schema.get("required", ()) else ""
        default = field.get("default")
        shown = "" if default in (None, "", [], {}) or isinstance(default, dict) else f"; {default}"
        meaning = field["description"].rsplit(" Unit:", 1)[0].replace("|", "\\|")
        value = shape(field) + limits(field) + shown
        text += f"| {mark}`{name}`{mark} | {value} | {field['unit']} | {meaning} |\n"
    return text


def tables() -> str:
    """Return every model's table, the document's first; what many share is told once."""
    whole = Document.model_json_schema()
    models = {"Document": whole, **whole["$defs"]}
    common = frozenset(LeafModel.model_fields) - {"cuts"}
    operators = {model.__name__ for model in OPERATORS.values()}
    leaves = {model.__name__ for model in LEAVES.values()}
    parts = []
    for name in [*FIRST, *sorted(set(models) - set(FIRST))]:
        schema = models[name]
        kind = schema["properties"].get("type", {}).get("const")
        group = next((word for word in ("Axis", "Contour", "Sweep") if name.endswith(word)), "")
        head = f"{group} `{kind}`".strip() if kind else name
        about = schema["description"]
        if name in operators:
            continue
        if name in leaves:
            # Only a double cone has something of its own to say about its cuts.
            own = {"cuts"} if name == "DoubleCone" else set()
            parts.append(table(head, about, schema, common | {"type"} | ({"cuts"} - own)))
        else:
            parts.append(table(head, about, schema, frozenset({"type"})))
        if name == FIRST[-1]:
            head = ", ".join(f"`{kind}`" for kind in OPERATORS)
            about = "Two or more solids, taken from the left: ((a op b) op c)."
            parts.append(table(head, about, models["Union"], frozenset({"type"})))
            head, about = "Every leaf", "What every leaf may have besides its shape."
            parts.append(table(head, about, LeafModel.model_json_schema(), frozenset()))
    return "\n".join(parts)


if __name__ == "__main__":
    before = PAGE.read_text(encoding="utf-8").split(START)[0]
    PAGE.write_text(before + START + "\n" + tables(), encoding="utf-8")
