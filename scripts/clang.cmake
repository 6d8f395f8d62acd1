# The toolchain of the presets: the clang that vectorises the many-light loops best among those installed.
# 16 comes first because it is the fastest measured (docs/conventions.md, "Compilers"), then the default of Debian 13.
# -DCMAKE_CXX_COMPILER=... on the command line wins.
if(NOT CMAKE_CXX_COMPILER)
  find_program(ZONAL_CLANG NAMES clang++-16 clang++-19 clang++-18 clang++-17 clang++ DOC "The clang of the presets")
  if(NOT ZONAL_CLANG)
    message(FATAL_ERROR "No clang++ found. scripts/bootstrap installs it, or configure without a preset to use another "
                        "compiler.")
  endif()
  set(CMAKE_CXX_COMPILER "${ZONAL_CLANG}")
endif()
