"""The JSON Schema of the study file, for editors."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

from axlespan.study.case import schema as case_schema
from axlespan.study.sweep.chance import METHODS
from axlespan.study.sweep.ranges import MOST
from axlespan.study.sweep.recording import QUANTITIES
from axlespan.study.sweep.spec import HISTORIES, KEYS

_QUANTITY: Final = {
    "type": ["number", "string"],
    "description": "A number with or without unit, such as 140 km/h.",
}
_COUNT: Final = {"type": "integer", "minimum": 1, "maximum": MOST}
_SEED: Final = {"type": "integer", "minimum": 0, "maximum": 2**63 - 1}


def study_schema() -> dict[str, Any]:
    """Return the JSON Schema (draft 2020-12) of the study file; descriptions name the units."""
    case = case_schema()
    own = {
        key: case[key] for key in ("type", "properties", "additionalProperties", "description") if key in case
    }
    properties = {
        "title": {"type": "string", "description": "Name of the study."},
        "base": {
            "description": "A case file, or a case; what varies may be missing in it.",
            # the last one: a value that vary gives may be missing anywhere
            "anyOf": [{"type": "string", "minLength": 1}, {"$ref": "#/$defs/BaseCase"}, {"type": "object"}],
        },
        "vary": _vary(),
        "zip": {
            "description": "Groups of paths whose lists go together.",
            "type": "array",
            "items": {"type": "array", "items": {"type": "string"}, "minItems": 2},
            "minItems": 1,
        },
        "sampling": _mapping(
            "How random variables are sampled.",
            {"method": {"enum": list(METHODS)}, "count": _COUNT, "seed": _SEED},
            ("method", "count"),
        ),
        "trains": {
            "description": "Trains by names, for vary: lists of entries as under train of a case.",
            "type": "object",
            "additionalProperties": {"type": ["array", "object"]},
        },
        "passage": _mapping(
            "How long each run goes on after its last wheel has left [s].", {"after": _QUANTITY}, ("after",)
        ),
        "histories": _mapping(
            "Histories that are kept.",
            {
                "variables": {"type": "array", "items": {"enum": list(HISTORIES)}, "minItems": 1},
                "every": _COUNT,
            },
            ("variables",),
        ),
        "records": _records(),
    }
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "axlespan study",
        "type": "object",
        "properties": {key: properties[key] for key in KEYS},
        "required": ["base", "vary"],
        "additionalProperties": False,
        "$defs": {**case["$defs"], "BaseCase": own, **_FORMS},
    }


def _mapping(
    description: str, properties: Mapping[str, Any], required: tuple[str, ...] = ()
) -> dict[str, Any]:
    return {
        "description": description,
        "type": "object",
        "properties": dict(properties),
        "required": list(required),
        "additionalProperties": False,
    }


def _vary() -> dict[str, Any]:
    forms = [{"$ref": f"#/$defs/{name}"} for name in ("Listed", "Range", "Seeds", "Factor", "Random")]
    return {
        "description": "Dotted paths into the case, and the values they take; all products are computed.",
        "type": "object",
        "minProperties": 1,
        "properties": {
            "train": {
                "description": "Names of trains or of a set such as hslm-a, or random traffic.",
                "anyOf": [{"type": "string"}, {"$ref": "#/$defs/Listed"}, {"$ref": "#/$defs/Mix"}],
            }
        },
        "additionalProperties": {"anyOf": forms},
    }


def _records() -> dict[str, Any]:
    return _mapping(
        "Records of a monitoring system.",
        {
            "sampling_rate": _QUANTITY,
            "quantity": {"enum": list(QUANTITIES)},
            "noise": {
                "type": "object",
                "properties": {"std": _QUANTITY, "share": _QUANTITY},
                "minProperties": 1,
                "maxProperties": 1,
                "additionalProperties": False,
            },
            "quantization": _mapping(
                "Converter: bits over ± range.",
                {"bits": {"type": "integer", "minimum": 2, "maximum": 32}, "range": _QUANTITY},
                ("bits", "range"),
            ),
            "seed": _SEED,
        },
        ("sampling_rate",),
    )


_RANGE: Final = {
    **_mapping(
        "From one value to another, by steps or evenly.",
        {"from": _QUANTITY, "to": _QUANTITY, "step": _QUANTITY, "count": _COUNT},
        ("from", "to"),
    ),
    "oneOf": [{"required": ["step"]}, {"required": ["count"]}],
}
_RANDOM: Final = {
    "description": "A random variable: normal, lognormal, uniform, triangular, or a name of scipy.stats.",
    "type": "object",
    "properties": {"distribution": {"type": "string"}},
    "required": ["distribution"],
    "additionalProperties": _QUANTITY,
}
_SPACE: Final = {"anyOf": [_QUANTITY, {"$ref": "#/$defs/Random"}]}
_FORMS: Final[Mapping[str, Any]] = {
    "Listed": {"description": "Values one after the other.", "type": "array", "minItems": 1},
    "Range": _RANGE,
    "Seeds": _mapping("Whole numbers that follow each other.", {"seeds": _COUNT, "first": _SEED}, ("seeds",)),
    "Factor": _mapping(
        "Factors on the value of the base.",
        {
            "factor": {
                "anyOf": [
                    {"type": "array", "items": {"type": ["number", "string"]}, "minItems": 1},
                    {"$ref": "#/$defs/Range"},
                    {"$ref": "#/$defs/Random"},
                ]
            }
        },
        ("factor",),
    ),
    "Random": _RANDOM,
    "Mix": _mapping(
        "Random traffic: trains drawn by their shares, one behind the other.",
        {
            "mix": {
                "type": "object",
                "minProperties": 1,
                "additionalProperties": {"type": ["number", "string"]},
            },
            "trains": {"type": "integer", "minimum": 1, "maximum": 100},
            "gap": _SPACE,
            "headway": _SPACE,
        },
        ("mix",),
    ),
}
