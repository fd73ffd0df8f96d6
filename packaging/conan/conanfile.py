"""Conan 2 recipe, which builds the tree that contains the recipe. See packaging/README.md."""
import os
import re

from conan import ConanFile
from conan.tools.build import stdcpp_library
from conan.tools.cmake import CMake, CMakeDeps, CMakeToolchain, cmake_layout
from conan.tools.files import copy, load, rmdir


class Pellucid(ConanFile):
    name = "pellucid"
    description = "Screen-space translucency and subsurface diffusion as Vulkan compute dispatches"
    license = "MIT"
    package_type = "library"
    settings = "os", "arch", "compiler", "build_type"
    options = {"shared": [True, False], "material": [True, False]}
    default_options = {"shared": False, "material": True}

    def set_version(self):
        text = load(self, os.path.join(self.recipe_folder, "..", "..", "CMakeLists.txt"))
        self.version = re.search(r"project\(pellucid VERSION ([\d.]+)", text)[1]

    def export_sources(self):
        tree = os.path.join(self.recipe_folder, "..", "..")
        for pattern in ("CMakeLists.txt", "LICENSE", "cmake/*", "compute/*", "module/*"):
            copy(self, pattern, tree, self.export_sources_folder)

    def layout(self):
        cmake_layout(self)

    def requirements(self):
        self.requires("glm/1.0.1")
        self.requires("vulkan-headers/1.3.268.0", transitive_headers=True)
        if self.options.material:
            self.requires("eigen/3.4.0")

    def build_requirements(self):
        self.tool_requires("cmake/[>=3.25]")
        self.tool_requires("glslang/1.3.268.0")

    def generate(self):
        CMakeDeps(self).generate()
        toolchain = CMakeToolchain(self)
        for name in ("BUILD_HARNESS", "BUILD_TESTS", "BUILD_BENCH", "WARNINGS_AS_ERRORS"):
            toolchain.cache_variables["PELLUCID_" + name] = False
        toolchain.cache_variables["PELLUCID_BUILD_MATERIAL"] = bool(self.options.material)
        toolchain.generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        copy(self, "LICENSE", self.source_folder, os.path.join(self.package_folder, "licenses"))
        CMake(self).install()
        for folder in ("cmake", "pkgconfig"):  # Conan writes these files itself
            rmdir(self, os.path.join(self.package_folder, "lib", folder))

    def package_info(self):
        self.cpp_info.set_property("cmake_file_name", "pellucid")
        self.library("pellucid", "pellucid", ["glm::glm", "vulkan-headers::vulkan-headers"])
        if self.options.material:
            self.library("material", "pellucid_material", ["pellucid", "eigen::eigen"])

    def library(self, component, name, requires):
        info = self.cpp_info.components[component]
        info.libs = [name]
        info.requires = requires
        info.set_property("cmake_target_name", "pellucid::" + component)
        info.set_property("pkg_config_name", name.replace("_", "-"))
        if self.options.shared:
            info.defines = ["PELLUCID_SHARED"]
        elif stdcpp_library(self):
            info.system_libs = [stdcpp_library(self)]
