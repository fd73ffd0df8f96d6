"""The recipes of packaging/, without vcpkg and Conan: stand-ins for what the recipes call configure the tree, and look for all its sources.

    python3 recipes_test.py SOURCE_FOLDER VERSION CMAKE GENERATOR
"""
import fnmatch
import importlib.util
import json
import os
import shutil
import subprocess
import sys
import tempfile
import types
import unittest

sys.dont_write_bytecode = True
ROOT, VERSION, CMAKE, GENERATOR = sys.argv[1:5]
PORT = os.path.join(ROOT, "packaging", "vcpkg", "pellucid")

# Functions that the port calls. The functions that only move installed files have nothing to do.
VCPKG = """cmake_minimum_required(VERSION 3.25)
function(vcpkg_check_features)
  cmake_parse_arguments(A "" "OUT_FEATURE_OPTIONS" "FEATURES" ${ARGN})
  list(GET A_FEATURES 0 feature)
  list(GET A_FEATURES 1 option)
  set(value OFF)
  if(feature IN_LIST FEATURES)
    set(value ON)
  endif()
  set(${A_OUT_FEATURE_OPTIONS} -D${option}=${value} PARENT_SCOPE)
endfunction()
function(vcpkg_cmake_configure)
  cmake_parse_arguments(A "" "SOURCE_PATH" "OPTIONS" ${ARGN})
  execute_process(COMMAND ${CMAKE_COMMAND} -S ${A_SOURCE_PATH} -B ${BUILD} -G ${GENERATOR} ${A_OPTIONS} COMMAND_ERROR_IS_FATAL ANY)
endfunction()
function(vcpkg_install_copyright)
  cmake_parse_arguments(A "" "" "FILE_LIST" ${ARGN})
  file(INSTALL ${A_FILE_LIST} DESTINATION ${CURRENT_PACKAGES_DIR})
endfunction()
foreach(name vcpkg_cmake_install vcpkg_cmake_config_fixup vcpkg_fixup_pkgconfig)
  cmake_language(EVAL CODE "function(${name})\\nendfunction()")
endforeach()
"""


def run(*command):
    result = subprocess.run(command, capture_output=True, text=True, check=False)
    return result.returncode, result.stdout + result.stderr


class Folder(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.build = os.path.join(self.folder.name, "build")

    def tearDown(self):
        self.folder.cleanup()

    def path(self, *parts):
        return os.path.join(self.folder.name, *parts)

    # CMake knew each option, all sources are there, and the libraries are those that the recipe promises.
    def check_build(self, log, libraries):
        self.assertNotIn("not used by the project", log)
        code, steps = run(CMAKE, "--build", self.build, "--", "-n")
        self.assertEqual(code, 0, steps)
        for library in ("pellucid", "pellucid_material"):
            self.assertEqual(f"lib{library}." in steps, library in libraries, steps)
        self.assertNotIn("gbuffer_harness", steps)


class Vcpkg(Folder):
    def test_port_names_this_version(self):
        with open(os.path.join(PORT, "vcpkg.json"), encoding="utf-8") as file:
            port = json.load(file)
        self.assertEqual((port["name"], port["version"]), ("pellucid", VERSION))

    def test_port_configures_the_tree(self):
        glslang = shutil.which("glslangValidator")
        os.makedirs(self.path("host", "tools", "glslang"))
        os.symlink(glslang, self.path("host", "tools", "glslang", "glslangValidator"))
        with open(self.path("port.cmake"), "w", encoding="utf-8") as file:
            file.write(VCPKG + f"include({PORT}/portfile.cmake)\n")
        for features, libraries in (("material", ["pellucid", "pellucid_material"]), ("", ["pellucid"])):
            code, log = run(CMAKE, f"-DFEATURES={features}", f"-DBUILD={self.build}", f"-DGENERATOR={GENERATOR}",
                            f"-DCURRENT_HOST_INSTALLED_DIR={self.path('host')}",
                            f"-DCURRENT_PACKAGES_DIR={self.path('package')}", "-P", self.path("port.cmake"))
            self.assertEqual(code, 0, log)
            self.check_build(log, libraries)
            with open(os.path.join(self.build, "CMakeCache.txt"), encoding="utf-8") as file:
                self.assertIn("PELLUCID_GLSLANG:FILEPATH=" + self.path("host"), file.read())
        self.assertTrue(os.path.exists(self.path("package", "LICENSE")))


class Attributes(types.SimpleNamespace):
    def __init__(self):
        super().__init__(properties={}, libs=[], requires=[], defines=[], system_libs=[])

    def set_property(self, name, value):
        self.properties[name] = value


class Components(dict):
    def __missing__(self, name):
        self[name] = Attributes()
        return self[name]


class Conan(Folder):
    # The modules that the recipe imports, and the recipe.
    def recipe(self, **options):
        test = self

        class ConanFile:
            def requires(self, reference, **_):
                test.requirements.append(reference.split("/")[0])

            tool_requires = requires

        class Toolchain:
            def __init__(self, conanfile):
                self.cache_variables = {}
                self.conanfile = conanfile

            def generate(self):
                test.variables = {"BUILD_SHARED_LIBS": self.conanfile.options.shared, **self.cache_variables}

        class Build:
            def __init__(self, conanfile):
                self.conanfile = conanfile

            def configure(self):
                variables = [f"-D{name}={'ON' if value else 'OFF'}" for name, value in test.variables.items()]
                code, test.log = run(CMAKE, "-S", self.conanfile.source_folder, "-B", test.build, "-G", GENERATOR, *variables)
                test.assertEqual(code, 0, test.log)

            def build(self):
                pass

            install = build

        def copy(_, pattern, source, target):
            copied = 0
            for folder, _, names in os.walk(os.path.join(source, pattern.split("/")[0]) if "/" in pattern else source):
                for name in names:
                    path = os.path.relpath(os.path.join(folder, name), source)
                    if fnmatch.fnmatch(path, pattern):
                        os.makedirs(os.path.dirname(os.path.join(target, path)), exist_ok=True)
                        shutil.copy(os.path.join(source, path), os.path.join(target, path))
                        copied += 1
                if "/" not in pattern:
                    break
            self.assertGreater(copied, 0, pattern)

        def load(_, path):
            with open(path, encoding="utf-8") as file:
                return file.read()

        modules = {"conan": {"ConanFile": ConanFile}, "conan.tools": {},
                   "conan.tools.build": {"stdcpp_library": lambda _: "stdc++"},
                   "conan.tools.cmake": {"CMake": Build, "CMakeDeps": Toolchain, "CMakeToolchain": Toolchain,
                                         "cmake_layout": lambda _: None},
                   "conan.tools.files": {"copy": copy, "load": load, "rmdir": lambda _, path: None}}
        for name, attributes in modules.items():
            sys.modules[name] = types.ModuleType(name)
            vars(sys.modules[name]).update(attributes)
        path = os.path.join(ROOT, "packaging", "conan", "conanfile.py")
        spec = importlib.util.spec_from_file_location("conanfile", path)
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        recipe = module.Pellucid()
        recipe.recipe_folder = os.path.dirname(path)
        recipe.export_sources_folder = recipe.source_folder = self.path("source")
        recipe.package_folder = self.path("package")
        for name, value in options.items():
            self.assertIn(value, recipe.options[name])
        recipe.options = types.SimpleNamespace(**{**recipe.default_options, **options})
        recipe.cpp_info = Attributes()
        recipe.cpp_info.components = Components()
        self.requirements = []
        return recipe

    def test_version_is_that_of_cmake(self):
        recipe = self.recipe()
        recipe.set_version()
        self.assertEqual(recipe.version, VERSION)

    def test_exported_sources_build(self):
        for options in ({}, {"shared": True, "material": False}):
            recipe = self.recipe(**options)
            recipe.export_sources()
            recipe.layout()
            recipe.requirements()
            recipe.build_requirements()
            recipe.generate()
            recipe.build()
            recipe.package()
            recipe.package_info()
            components = recipe.cpp_info.components
            self.check_build(self.log, [name for component in components.values() for name in component.libs])
            self.assertEqual({info.properties["cmake_target_name"] for info in components.values()},
                             {"pellucid::pellucid"} | ({"pellucid::material"} if recipe.options.material else set()))
            for info in components.values():
                self.assertEqual(info.defines, ["PELLUCID_SHARED"] if recipe.options.shared else [])
                for required in info.requires:
                    self.assertIn(required.split("::")[0], [*self.requirements, *components])
            self.assertTrue(os.path.exists(self.path("package", "licenses", "LICENSE")))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
