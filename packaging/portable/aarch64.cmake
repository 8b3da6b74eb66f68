# Builds for 64-bit ARM on Debian 12 with its cross compiler and libraries (docs/install.md); what the build makes runs in
# the emulator.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-aarch64-static)
set(PYTHON_MODULE_EXTENSION .cpython-311-aarch64-linux-gnu.so)
set(CPACK_DEBIAN_PACKAGE_ARCHITECTURE arm64)
