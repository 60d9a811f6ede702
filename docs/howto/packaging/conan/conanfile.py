"""Builds the tree in which this file lies: conan create docs/howto/packaging/conan"""
import os

from conan import ConanFile
from conan.tools.build import check_min_cppstd
from conan.tools.cmake import CMake, CMakeDeps, CMakeToolchain, cmake_layout
from conan.tools.files import copy, rmdir


class Accrete(ConanFile):
    name = "accrete"
    version = "0.1.0"
    license = "MIT"
    description = "3D models of edges from stereo images of something that moves"
    package_type = "static-library"
    settings = "os", "compiler", "build_type", "arch"
    options = {"hal": [True, False], "with_png": [True, False], "with_jpeg": [True, False], "with_yaml": [True, False]}
    default_options = {"hal": True, "with_png": True, "with_jpeg": True, "with_yaml": True}

    def export_sources(self):
        tree = os.path.join(self.recipe_folder, "..", "..", "..", "..")
        for pattern in ("CMakeLists.txt", "LICENSE", "cmake/*", "include/*", "src/*", "hal/*"):
            copy(self, pattern, src=tree, dst=self.export_sources_folder)

    def layout(self):
        cmake_layout(self)

    def requirements(self):
        self.requires("eigen/3.4.0", visible=False)  # to compile it alone: no header of ours names it
        if self.options.hal and self.options.with_png:
            self.requires("libpng/[>=1.6 <2]")
        if self.options.hal and self.options.with_jpeg:
            self.requires("libjpeg-turbo/[>=2.1 <4]")
        if self.options.hal and self.options.with_yaml:
            self.requires("yaml-cpp/[>=0.7 <1]")

    def validate(self):
        check_min_cppstd(self, 20)

    def generate(self):
        CMakeDeps(self).generate()
        toolchain = CMakeToolchain(self)
        toolchain.cache_variables["ACCRETE_TESTS"] = "OFF"
        toolchain.cache_variables["ACCRETE_TOOLS"] = "OFF"
        toolchain.cache_variables["ACCRETE_WITH_LIBCAMERA"] = "OFF"
        toolchain.cache_variables["ACCRETE_HAL"] = "ON" if self.options.hal else "OFF"
        for name in ("png", "jpeg", "yaml"):
            toolchain.cache_variables["ACCRETE_WITH_" + name.upper()] = "ON" if getattr(self.options, "with_" + name) else "OFF"
        toolchain.generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        copy(self, "LICENSE", src=self.source_folder, dst=os.path.join(self.package_folder, "licenses"))
        CMake(self).install()
        for folder in ("lib/cmake", "lib/pkgconfig", "share"):  # Conan makes its own
            rmdir(self, os.path.join(self.package_folder, folder))

    def package_info(self):
        self.cpp_info.set_property("cmake_file_name", "accrete")
        core = self.cpp_info.components["core"]
        core.libs = ["accrete"]
        core.set_property("cmake_target_name", "accrete::accrete")
        core.set_property("pkg_config_name", "accrete")
        if self.options.hal:
            hal = self.cpp_info.components["hal"]
            hal.libs = ["accrete_hal"]
            hal.set_property("cmake_target_name", "accrete::hal")
            hal.set_property("pkg_config_name", "accrete-hal")
            hal.requires = ["core"]
            hal.system_libs = ["pthread"]
            hal.requires += [package for name, package in (("png", "libpng::libpng"), ("jpeg", "libjpeg-turbo::turbojpeg"),
                                                           ("yaml", "yaml-cpp::yaml-cpp")) if getattr(self.options, "with_" + name)]
