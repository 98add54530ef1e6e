"""Imports go one way, and `import ratfit` and `ratfit --help` stay light."""

import ast
import subprocess
import sys
from pathlib import Path

import pytest

import ratfit

ROOT = Path(ratfit.__file__).parent

# DESIGN's order, lowest first; a module may import from its own layer and from those before it.
LAYERS = [
    ("_deadline",),
    ("_parse",),
    ("brdf",),
    ("_multiprecise",),
    ("_target", "_rational_integral", "_pieces", "_condition", "_form"),
    ("_problem", "_problem_file", "_problem_text", "_inline", "_generators", "_field", "_integral", "_series"),
    ("_inverse", "_jets", "_system", "_rows", "_lower", "_kernel", "_ball"),
    ("_solver",),
    ("_fit", "_poles", "_fraction"),
    ("_verify",),
    ("_candidates",),
    ("_diagnosis",),
    ("_derive",),
    ("_study", "_schedule", "_setting", "_double_double"),
    ("_sampling", "_record"),
    ("_error", "_speed"),
    ("models",),
    ("gallery", "baselines"),
    ("_bench",),
    ("claims",),
    ("report", "plot"),
    ("cli",),
]
LEVEL = {name: level for level, names in enumerate(LAYERS) for name in names}
MAY_LOAD_JAX = {"_lower", "_kernel", "_double_double", "_sampling", "_error", "_speed", "models"}


def modules():
    return sorted(p for p in ROOT.rglob("*.py") if p.name != "__init__.py" or p.parent != ROOT)


def room(path):
    return path.relative_to(ROOT).parts[0].removesuffix(".py")


def imported(nodes):
    for node in nodes:
        if isinstance(node, ast.ImportFrom) and node.module:
            yield node.module
        elif isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)


def test_every_room_has_a_layer():
    assert {room(path) for path in modules()} <= set(LEVEL)


@pytest.mark.parametrize("path", modules(), ids=lambda p: str(p.relative_to(ROOT)))
def test_imports_go_one_way(path):
    """At the top of a module; sugar inside functions may reach upwards."""
    top = ast.parse(path.read_text()).body
    for name in imported(top):
        if name.startswith("ratfit."):
            assert LEVEL[name.split(".")[1]] <= LEVEL[room(path)], f"{room(path)} imports {name}"


@pytest.mark.parametrize("path", modules(), ids=lambda p: str(p.relative_to(ROOT)))
def test_jax_is_loaded_where_it_may_be_and_never_at_the_top(path):
    tree = ast.parse(path.read_text())
    assert not any(name.split(".")[0] in ("jax", "matplotlib") for name in imported(tree.body))
    if room(path) not in MAY_LOAD_JAX:
        assert not any(name.split(".")[0] == "jax" for name in imported(ast.walk(tree)))


COMMAND = """
sys.argv = {arguments!r}
try:
    from ratfit.cli import main; main()
except SystemExit:
    pass
"""


@pytest.mark.parametrize(
    "code",
    [
        "import ratfit",
        COMMAND.format(arguments=["ratfit", "--help"]),
        COMMAND.format(arguments=["ratfit", "derive", "eq19"]),
    ],
)
def test_light_imports(code):
    report = "print([m for m in ('jax', 'matplotlib', 'scipy') if m in sys.modules], file=sys.stderr)"
    done = subprocess.run(
        [sys.executable, "-c", f"import sys\n{code}\n{report}"], capture_output=True, text=True, check=True
    )
    assert done.stderr.strip().splitlines()[-1] == "[]"


def test_public_names_are_what_init_says_and_belong_to_ratfit():
    public = [name for name in vars(ratfit) if not name.startswith("_") and name not in ("importlib", "Any")]
    for name in public:
        found = getattr(ratfit, name)
        assert getattr(found, "__module__", "ratfit").startswith("ratfit"), name
        assert getattr(found, "__doc__", None), f"{name} has no docstring"
    for name in ("derive", "Problem", "Target", "Value", "Derivative", "Integral", "Rational", "Form", "Power"):
        assert name in public
    for name in ("measure_error", "measure_speed", "peers", "schedule", "study", "Watch"):
        assert callable(getattr(ratfit, name))
    assert "peak_mean" in ratfit.DEFINITIONS and "numpy" in ratfit.BACKENDS


def test_no_text_is_ever_evaluated():
    banned = {"eval", "exec", "sympify", "parse_expr", "__import__"}
    for path in modules():
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.Call):
                name = getattr(node.func, "id", getattr(node.func, "attr", ""))
                if name == "sympify":  # of numbers and expressions alone: strict, or an element of a field
                    assert path.name in ("_field.py", "_lower.py", "_kernel.py", "_schedule.py") or "_schedule" in str(
                        path
                    ), path
                else:
                    assert name not in banned, f"{path}: {name}"
