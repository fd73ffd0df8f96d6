"""What files of the project say of each other: links, commands, versions, and which folder includes which.

    python3 project_test.py PROJECT PELLUCID [PELLUCID_BENCH]

The programs tell which options they have; CONTRIBUTING.md has the reasons of the include arrows.
"""
import functools
import pathlib
import re
import shlex
import subprocess
import sys
import unittest

ROOT = pathlib.Path(sys.argv[1])
PROGRAMS = {pathlib.Path(path).name: path for path in sys.argv[2:]}


def read(file):
    return (ROOT / file).read_text(encoding="utf-8")


def files(folders, *endings):
    found = [file for folder in folders for file in sorted((ROOT / folder).rglob("*")) if file.suffix in endings]
    assert found, f"{folders} have no sources: the test looks in the wrong place"
    return found


def documents():
    """Without what a build or a run may have left in the project's folder."""
    return [*ROOT.glob("*.md"), *files(["docs", "bench", "packaging", ".github"], ".md")]


def found(pattern, texts):
    """File and match of each place where the pattern is."""
    return [(file, match) for file in texts for match in re.finditer(pattern, read(file))]


def anchors(markdown):
    """Of all headings, as GitHub makes them of ASCII."""
    names = []
    for heading in re.findall(r"^#+ (.*)$", re.sub(r"^```.*?^```", "", markdown, flags=re.M | re.S), re.M):
        words = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).lower()
        anchor = re.sub(r"[^a-z0-9_-]", "", words.replace(" ", "-"))
        names.append(anchor + (f"-{names.count(anchor)}" if anchor in names else ""))
    return names


@functools.lru_cache(None)
def help_of(*command):
    return subprocess.run([*command, "--help"], capture_output=True, text=True, check=False)


def unknown(program, words):
    """A command or option that the program does not have; empty: it has all."""
    command = [words[0]] if program == "pellucid" else []
    text = help_of(PROGRAMS[program], *command).stdout
    if f"Usage: {' '.join([program, *command])} " not in text:
        return f"there is no {words[0]}"
    known = {name for names in re.findall(r"^  (?:(-\w),)?(--[\w-]+)", text, re.M) for name in names}
    return "".join(f"there is no {word}; " for word in words if re.match(r"--?[a-z]", word) and word.split("=")[0] not in known)


def problem(program, words):
    """What is wrong with a command line; empty: nothing. The program checks values before it prints its help."""
    parsed = help_of(PROGRAMS[program], *words)
    return unknown(program, words) or (parsed.stderr if parsed.returncode != 0 else "")


def commands(file):
    """Lines of code blocks, fenced or indented, that run a program: its name and its words."""
    text = read(file).replace("\\\n", "")
    blocks = re.findall(r"^```\w*\n(.*?)^```", text, re.M | re.S)
    for line in [*"".join(blocks).splitlines(), *re.findall(r"^    (.*)$", text, re.M)]:
        match = re.match(r"(?:build/bin/)?(pellucid(?:_bench)?) ([^>|]*)", line.strip())
        if match:  # "..." stands for options of the line before
            yield match[1], [word for word in shlex.split(match[2], comments=True) if word != "..."]


class Documents(unittest.TestCase):
    def holds(self, failures):
        self.assertFalse(failures, "\n" + "\n".join(failures))

    def test_links_lead_somewhere(self):
        failures, links = [], [(file, match[1]) for file, match in found(r"\]\(([^)\s]+)\)", documents()) if "://" not in match[1]]
        for file, target in links:
            path, _, anchor = target.partition("#")
            to = file.parent / path if path else file
            if not to.exists():
                failures.append(f"{file}: nothing is at {target}")
            elif anchor and anchor not in anchors(read(to)):
                failures.append(f"{file}: no heading has the anchor of {target}")
        self.assertGreater(len(links), 60)
        self.holds(failures)

    def test_sources_name_documents_that_exist(self):
        sources = files(["module", "compute", "gbuffer_harness", "bench", "tests", "tools"],
                        ".h", ".cpp", ".glsl", ".comp", ".py", ".sh", ".txt")
        names = found(r"\bdocs/[\w/.-]+\.md", sources)
        self.assertGreater(len(names), 20)
        self.holds([f"{file} names {match[0]}" for file, match in names if not (ROOT / match[0]).exists()])

    def test_commands_parse(self):
        lines = [(file, *command) for file in documents() for command in commands(file) if command[0] in PROGRAMS]
        self.assertGreater(len(lines), 20)
        self.holds([f"{file}: {program} {' '.join(words)}: {problem(program, words)}" for file, program, words in lines
                    if words[-1] != "--help" and problem(program, words)])
        self.assertEqual(problem("pellucid", ["replay", "a.exr", "--nothing"]), "there is no --nothing; ")
        self.assertIn("not in range", problem("pellucid", ["replay", "a.exr", "--repeat", "-1"]))

    def test_options_in_the_text_exist(self):
        """Words of running text such as `pellucid replay --png`, which have no values."""
        spans = found(r"`(?:build/bin/)?pellucid ([a-z-]+)([^`]*)`", documents())
        self.assertGreater(len(spans), 10)
        self.holds([f"{file}: {match[0]}: {unknown('pellucid', words)}" for file, match in spans
                    if unknown("pellucid", words := [match[1], *re.findall(r"(?:^|\s)(--[a-z-]+)", match[2])])])
        self.assertEqual(unknown("pellucid", ["nothing"]), "there is no nothing")

    def test_tasks_exist(self):
        listed = re.search(r'\n  deps \|([a-z_ |]+)\) "\$@"', read("run"))[1]
        tasks = {"deps", "test", "shader-stats", *listed.replace("|", " ").split()}
        self.assertGreater(len(tasks), 10)
        self.holds([f"{file}: there is no {match[0]}" for file, match in found(r"\./run ([a-z_-]+)", documents())
                    if match[1] not in tasks])

    def test_every_command_that_is_recorded_is_named(self):
        """What a recording disturbs follows from the commands that it calls."""
        recorded = re.findall(r"X\((vkCmd\w+)\)", read("module/src/context.h"))
        self.assertGreater(len(recorded), 3)
        page = read("docs/integration.md")
        self.holds([command for command in recorded if f"`{command}`" not in page])

    def test_the_readme_names_what_the_build_needs(self):
        """Everything that the library's build looks for."""
        words = {"glm": "GLM", "Eigen3": "Eigen", "PELLUCID_VULKAN_INCLUDE": "the Vulkan headers",
                 "PELLUCID_GLSLANG": "`glslangValidator`"}
        builds = ["CMakeLists.txt", "cmake/shaders.cmake", "cmake/pellucid_target.cmake", "cmake/vulkan_headers.cmake",
                  "module/CMakeLists.txt", "module/material/CMakeLists.txt"]
        needed = {match[1] for _, match in found(r"find_(?:package|path|program|library)\((\w+)", builds)}
        self.assertEqual(needed, set(words))
        self.holds([word for word in words.values() if word not in read("README.md")])

    def test_the_readme_lists_the_images(self):
        fields = re.findall(r'"(\w+)", &PellucidFrame::\w+, (true|false)', read("module/src/images.h"))
        rows = re.findall(r"^\| `(\w+)` \| [^|]* \| (yes|no) \|", read("README.md"), re.M)
        self.assertGreater(len(fields), 5)
        self.assertEqual(dict(rows), {name: "yes" if required == "true" else "no" for name, required in fields})

    def test_versions_agree(self):
        header, changes = read("module/include/pellucid/pellucid.h"), read("CHANGELOG.md")
        version = re.search(r'PELLUCID_VERSION "([\d.]+)"', header)[1]
        self.assertEqual(re.search(r"project\(pellucid VERSION ([\d.]+)", read("CMakeLists.txt"))[1], version)
        self.assertEqual(re.search(r"\n## ([\d.]+)", changes)[1], version)
        self.assertEqual(re.search(r"`PELLUCID_HEADER_VERSION` (\d+)", changes)[1],
                         re.search(r"PELLUCID_HEADER_VERSION (\d+)", header)[1])


# Folder, pattern that its code does not have, reason, and a file or a folder of files for which the rule is not.
RULES = [
    ("compute/shared", r'#include\s*[<"](?!glm/|pellucid_)', "shared headers include nothing but GLM types and each other", ""),
    ("compute/lib", r"\blayout\s*\(", "lib is maths: bindings belong to passes", ""),
    ("compute/lib", r'#include\s*"(?!lib/|shared/)', "lib does not know the passes", ""),
    ("compute", r'#include\s*"(pellucid/|capture/|replay/|scene/)', "shaders include shaders", ""),
    ("module", r'#include\s*"(capture|replay|scene|common|cli|reference|raster)/', "the module does not know the harness", ""),
    ("module", r"\bprintf|\bfprintf|#include\s*<(iostream|fstream|cstdio)>", "the module writes no files and no output", ""),
    ("module", r"vkAllocateMemory|vkQueueSubmit|vkQueueWaitIdle|vkDeviceWaitIdle|vkWaitForFences|vkCreateImage\b",
     "the caller owns memory, submission and waits", ""),
    ("module", r"vk\.vkCmd", "only record.cpp records", "record.cpp"),
    ("module/src", r"#include\s*<Eigen", "Eigen is the material compiler's", ""),
    ("module/include", r"#include\s*<(string|vector|array|memory|functional|glm)|\bthrow\b|std::", "the public API is C", ""),
    ("gbuffer_harness", r'#include\s*"(bench|tests)/', "the harness does not know its users", ""),
    ("gbuffer_harness/reference", r'#include\s*"(lib/|frame/|translucency/|diffusion/|gather/|shared/|compute/|replay/)',
     "the reference is independent of the shaders", ""),
    ("gbuffer_harness/replay", r"#include\s*<(OpenEXR|ImfI|nlohmann)", "replay needs no files, so that the bench does not either", ""),
    ("gbuffer_harness/metrics", r'#include\s*(<(OpenEXR|Imf|nlohmann|CLI)|"(capture/(exr|read|write)|replay/))',
     "metrics know captures and images, no files", ""),
    ("gbuffer_harness/scene", r"#include\s*<(OpenEXR|Imf|nlohmann)", "procedural scenes need no files", ""),
    ("gbuffer_harness/raster", r'#include\s*(<(OpenEXR|Imf|nlohmann|tiny_gltf)|"(capture/(exr|read|write)|gltf/|replay/|view/))',
     "the rasterizer knows models and captures, neither files nor replays", ""),
    ("gbuffer_harness/sample", r'#include\s*"view/', "integrators copy the sample, and not the viewer", ""),
    ("gbuffer_harness/cli", r"#include\s*<CLI", "each source with CLI11 takes many seconds to compile", "command.cpp"),
    ("gbuffer_harness", r'#include\s*[<"]tiny_gltf|tinygltf::', "all but the loader speak raster/model.h", "gltf"),
]


class Layering(unittest.TestCase):
    def test_holds(self):
        for folder, pattern, reason, other in RULES:
            for file in files([folder], ".h", ".cpp", ".glsl", ".comp"):
                code = re.sub(r"//[^\n]*|/\*.*?\*/", "", read(file), flags=re.S)  # comments may name what code must not use
                match = re.search(pattern, code) if other not in (file.name, file.parent.name) else None
                self.assertIsNone(match, f"{file}: {reason}")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
