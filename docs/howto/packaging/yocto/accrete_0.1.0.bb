# Builds the tree in which this file lies. Needs meta-oe (fmt, yaml-cpp) and, for cameras by libcamera, meta-multimedia.
SUMMARY = "3D models of edges from stereo images of something that moves"
LICENSE = "MIT"
LIC_FILES_CHKSUM = "file://LICENSE;md5=1251fb1d580661792ca59297b75bb04d"
DEPENDS = "libeigen"

inherit cmake pkgconfig externalsrc
EXTERNALSRC = "${@os.path.abspath(os.path.realpath(d.getVar('FILE')) + '/../../../../..')}"
EXTERNALSRC_BUILD = "${WORKDIR}/build"

PACKAGECONFIG ??= "tools png jpeg yaml"
PACKAGECONFIG[tools] = "-DACCRETE_TOOLS=ON,-DACCRETE_TOOLS=OFF,cli11 fmt nlohmann-json libpng"
PACKAGECONFIG[png] = "-DACCRETE_WITH_PNG=ON,-DACCRETE_WITH_PNG=OFF,libpng"
PACKAGECONFIG[jpeg] = "-DACCRETE_WITH_JPEG=ON,-DACCRETE_WITH_JPEG=OFF,libjpeg-turbo"
PACKAGECONFIG[yaml] = "-DACCRETE_WITH_YAML=ON,-DACCRETE_WITH_YAML=OFF,yaml-cpp"
PACKAGECONFIG[libcamera] = "-DACCRETE_WITH_LIBCAMERA=ON,-DACCRETE_WITH_LIBCAMERA=OFF,libcamera"
EXTRA_OECMAKE = "-DACCRETE_TESTS=OFF"

# The libraries are static: a package of the library itself would be empty.
PACKAGES =+ "${PN}-tools"
FILES:${PN}-tools = "${bindir}/accrete ${datadir}/bash-completion"
ALLOW_EMPTY:${PN} = "1"
