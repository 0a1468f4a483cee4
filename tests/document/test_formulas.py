"""A formula means what Python would mean by it, and nothing else is a formula."""

from __future__ import annotations

import ast
import math
import time

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from phantom.document.expressions import (
    FUNCTIONS,
    Call,
    Comparison,
    Conditional,
    Constant,
    Expression,
    Negation,
    Operation,
    Variable,
    walk,
)
from phantom.document.formula_text import parse_formula
from phantom.document.formula_tokens import FormulaError
from tests.oracles.formulas import arithmetic, by_hand, comparisons, numbers, texts

SIGNS: dict[type, str] = {
    ast.Add: "+",
    ast.Sub: "-",
    ast.Mult: "*",
    ast.Div: "/",
    ast.Pow: "**",
    ast.Lt: "<",
    ast.LtE: "<=",
    ast.Gt: ">",
    ast.GtE: ">=",
    ast.Eq: "==",
    ast.NotEq: "!=",
}


class OutsideError(Exception):
    pass


def as_python_reads(text: str) -> Expression:
    """The tree that Python's own grammar gives a text, if our language has all of it."""
    try:
        tree = ast.parse(text.strip(), mode="eval")
    except SyntaxError:
        raise OutsideError from None
    return translated(tree.body)


def translated(node: ast.expr) -> Expression:
    match node:
        case ast.Constant(value=int() | float() as value) if not isinstance(value, bool):
            return Constant(float(value))
        case ast.Name(id="pi"):
            return Constant(math.pi)
        case ast.Name(id="u" | "x" as name):
            return Variable(name)
        case ast.UnaryOp(op=ast.USub(), operand=operand):
            return Negation(translated(operand))
        case ast.BinOp(left, op, right) if type(op) in SIGNS:
            return Operation(SIGNS[type(op)], translated(left), translated(right))
        case ast.IfExp(test=ast.Compare() as test, body=body, orelse=orelse):
            if not all(type(op) in SIGNS for op in test.ops):
                raise OutsideError
            operands = (test.left, *test.comparators)
            condition = Comparison(
                tuple(SIGNS[type(op)] for op in test.ops), tuple(translated(o) for o in operands)
            )
            return Conditional(condition, translated(body), translated(orelse))
        case ast.Call(func=ast.Name(id=name), args=args, keywords=[]) if name in FUNCTIONS:
            fewest, most = FUNCTIONS[name]
            if fewest <= len(args) <= most:
                return Call(name, tuple(translated(argument) for argument in args))
    raise OutsideError


def read(text: str) -> tuple[Expression | None, FormulaError | None]:
    try:
        return parse_formula(text, ("u", "x")), None
    except FormulaError as error:
        return None, error


token_soup = st.lists(
    numbers
    | arithmetic
    | comparisons
    | st.sampled_from(["u", "x", "pi", "if", "else", "(", ")", "sin", "max", "atan2", ","])
    | st.sampled_from(["and", "not", "y", "is", "True", "lambda", "%", "//", "."]),
    max_size=12,
).map(" ".join)


@given(texts)
@settings(max_examples=500, deadline=None)
def test_a_formula_is_the_tree_that_python_reads(text: str) -> None:
    try:
        expected = as_python_reads(text)
    except OutsideError:
        with pytest.raises(FormulaError):
            parse_formula(text, ("u", "x"))
    else:
        assert parse_formula(text, ("u", "x")) == expected


@given(token_soup | texts.map(lambda t: t.replace("(", "", 1)))
@settings(max_examples=500, deadline=None)
def test_what_python_does_not_read_is_no_formula_either(text: str) -> None:
    found, refusal = read(text)
    if found is not None:
        assert found == as_python_reads(text)
        return
    assert refusal is not None
    assert 1 <= refusal.column <= len(text) + 1
    if ", )" not in text:  # Python lets a list of arguments end with a comma
        with pytest.raises(OutsideError):
            as_python_reads(text)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("-2**2", -4),
        ("2**3**2", 512),
        ("2**-1", 0.5),
        ("-2**-2", -0.25),
        ("8/4/2", 1),
        ("1-2-3", -4),
        ("2+3*4", 14),
        ("1 if 2 < 3 < 3 else 2 if 1 != 1 else 3", 3),
        ("\t(1\n+ 2) * 3", 9),
        ("2 * - 3", -6),
    ],
)
def test_precedence_and_grouping(text: str, value: float) -> None:
    assert by_hand(parse_formula(text, ()), math) == value


REFUSED = [
    ("", 1, "found the end at column 1; expected a number, a name, - or ("),
    ("  ", 3, "found the end"),
    ("u +", 4, "found the end at column 4; expected a number"),
    ("2u", 2, "found 'u' at column 2; expected an operator"),
    ("u u", 3, "expected an operator or the end"),
    ("u^2", 2, "found '^' at column 2; expected ** for a power"),
    ("+u", 1, "found '+'"),
    ("u // 2", 4, "found '/' at column 4; expected a number"),
    ("u % 2", 3, "found '%'"),
    ("y", 1, "found 'y' at column 1; expected u, pi or a function: sin cos"),
    ("sin", 4, "expected ( after sin"),
    ("sin u", 5, "found 'u' at column 5; expected ( after sin"),
    ("u(2)", 2, "found '(' at column 2; expected an operator"),
    ("sin(u", 6, "expected an operator, a comma or )"),
    ("(u", 3, "expected an operator or )"),
    ("u)", 2, "found ')'"),
    ("sin(u, 1)", 1, "found 2 arguments of sin at column 1; expected 1"),
    ("1 + max(u)", 5, "found 1 argument of max at column 5; expected 2 to 100"),
    ("sin()", 5, "found ')'"),
    ("u < 1", 1, "found a comparison at column 1; expected a number"),
    ("(u < 1) + 1", 1, "found a comparison"),
    ("1 if u else 2", 6, "found a number at column 6; expected a comparison"),
    ("1 if u < 2", 11, "found the end at column 11; expected else"),
    ("1 if u < 2 and u > 1 else 0", 12, "found 'and' at column 12; expected else"),
    ("1 if not u < 2 else 0", 6, "found 'not'"),
    ("1 if (u < 2) < 3 else 0", 6, "found a comparison"),
    ("u ** 65", 6, "found the exponent 65 at column 6; expected at most 64"),
    ("u ** -(64.5)", 6, "found the exponent 64.5"),
    ("1e999", 1, "found '1e999' at column 1; expected at most 1e18"),
    ("1_000", 2, "found '_000'"),
    ("0x10", 2, "found 'x10'"),
    ("1j", 2, "found 'j'"),
    ("u.real", 2, "found '.'"),
    ("u[0]", 2, "found '['"),
    ("'u'", 1, 'found "\'"'),
    ("u := 1", 3, "found ':'"),
    ("lambda: 0", 7, "found ':'"),
    ("__import__('os').system('ls')", 12, 'found "\'"'),
    ("__import__(u)", 1, "found '__import__'"),
    ("().__class__", 3, "found '.'"),
    ("True", 1, "found 'True'"),
    ("nan", 1, "found 'nan'"),
    ("ｓin(u)", 1, "U+FF53"),
    ("u − 1", 3, "U+2212"),
    ("u\u00a0+ 1", 2, "U+00A0"),
    ("²", 1, "U+00B2"),
    ("١", 1, "U+0661"),
    ("u\x00", 2, r"found '\x00'"),
]


@pytest.mark.parametrize(("text", "column", "said"), REFUSED, ids=[row[0] for row in REFUSED])
def test_what_is_no_formula_is_refused_at_its_column(text: str, column: int, said: str) -> None:
    with pytest.raises(FormulaError) as refusal:
        parse_formula(text, ("u",))
    assert refusal.value.column == column
    assert said in str(refusal.value)


@pytest.mark.parametrize(
    "text",
    [
        "(" * 100_000 + "u" + ")" * 100_000,
        "(" * 900 + "u" + ")" * 900,
        "-" * 1_999 + "u",
        "sin(" * 400 + "u" + ")" * 400,
        "u" + "**1" * 600,
        "u" + "+u" * 900,
        "1 if u<1 else " * 120 + "1",
        "1 if 1<" * 200,
        "max(" + ",".join("u" * 600) + ")",
        "9" * 1_000_000,
        "9" * 1_999,
        "9**" * 600 + "9",
        " " * 1_000_000,
        "a" * 1_999,
        "." * 1_999,
        "1e" * 999,
    ],
    ids=range(16),
)
def test_what_is_too_long_or_too_deep_is_refused_at_once(text: str) -> None:
    start = time.thread_time()
    with pytest.raises(FormulaError) as refusal:
        parse_formula(text, ("u",))
    assert time.thread_time() - start < 0.2
    assert len(str(refusal.value)) < 200


def test_a_formula_as_long_and_deep_as_is_allowed_is_read() -> None:
    sum_of_100 = parse_formula("+".join(["u"] * 100), ("u",))
    assert sum(1 for _ in walk(sum_of_100)) == 199
    assert parse_formula("(" * 99 + "u" + ")" * 99, ("u",)) == Variable("u")
    assert parse_formula("u".ljust(2_000), ("u",)) == Variable("u")


@given(st.text(max_size=40))
@settings(max_examples=500, deadline=None)
def test_any_text_is_a_formula_or_refused(text: str) -> None:
    found, refusal = read(text)
    assert (found is None) == (refusal is not None)
    assert str(refusal).encode()
