"""Tables of the documents from the code.

    python3 code_tables.py --check|--update PELLUCID_CODE_TABLES

The program prints a table by its name; that of the constants follows from comments.
"""
import pathlib
import re
import subprocess
import sys

from generated_block import put

ROOT = pathlib.Path(__file__).parent.parent
DOCUMENTS = {"features": "docs/performance.md", "errors": "docs/accuracy.md", "domains": "docs/materials.md",
             "gltf": "docs/captures.md", "stress": "CONTRIBUTING.md"}
# Fitted numbers make a method hard to trust beyond the frames that they were fitted to.
MOST_MEASURED = 25


def measured(file):
    """Name, value and basis of constants whose comment has "Measured: ", up to the comment's end or a period.

    A comment stands before its constant or on the constant's line."""
    comment = ""
    for line in file.read_text(encoding="utf-8").splitlines():
        code, slashes, said = line.partition("//")
        if slashes:
            comment += " " + said.strip()
        if slashes and not code.strip() or code.startswith("#ifndef"):  # a constant that the build may set
            continue
        basis = re.search(r"Measured: (.*?)(?:\.(?: .*)?)?$", comment)
        if basis:
            constant = re.fullmatch(r"\s*(?:#define (\w+) (.+?)|(?:static )?const(?:expr)? \w+ (\w+) = (.+?);)\s*", code)
            if not constant:
                sys.exit(f"{file}: no constant follows \"{comment.strip()}\"")
            yield constant[1] or constant[3], constant[2] or constant[4], basis[1]
        comment = ""


def constants_table():
    files = sorted(file for folder in ("compute", "module/src") for file in (ROOT / folder).rglob("*") if file.is_file())
    rows = [(file, *constant) for file in files for constant in measured(file)]
    values = sum(1 + value.count(",") for _, _, value, _ in rows)
    if values > MOST_MEASURED:
        sys.exit(f"{values} values are measured, more than {MOST_MEASURED}: derive some or drop them")
    return "| constant | value | file | measured on |\n|-|-|-|-|\n" + "".join(
        f"| `{name}` | {value} | `{file.relative_to(ROOT)}` | {basis} |\n" for file, name, value, basis in rows)


if __name__ == "__main__":
    if len(sys.argv) != 3 or sys.argv[1] not in ("--check", "--update"):
        sys.exit(__doc__)
    mode, program = sys.argv[1:]
    for table, document in DOCUMENTS.items():
        put(ROOT / document, table, subprocess.run([program, table], check=True, capture_output=True, text=True).stdout, mode)
    put(ROOT / "docs/how-it-works.md", "constants", constants_table(), mode)
