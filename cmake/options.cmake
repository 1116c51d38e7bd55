set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)  # the OpenNI2 plug-ins are shared libraries made of the same parts

option(KINECTLAB_WERROR "Warnings are errors" OFF)
option(BUILD_TESTING "Build the unit tests" OFF)
set(KINECTLAB_SANITIZE "" CACHE STRING "Sanitizers for -fsanitize=, comma separated")

# No -march=native: mixed vector flags with Debian's PCL crash through Eigen's alignment.
# Nobody reads errno or floating-point exceptions; without them loops with a comparison vectorise.
add_compile_options(-Wall -Wextra -Wpedantic -Wno-missing-field-initializers -fno-math-errno -fno-trapping-math)
# GCC 12 warns of buffers inside its own and Eigen's inlined code.
add_compile_options($<$<CONFIG:RelWithDebInfo>:-Wno-array-bounds> -Wno-stringop-overflow -Wno-maybe-uninitialized)
set(CMAKE_CXX_FLAGS_RELWITHDEBINFO "-O3 -g1 -DNDEBUG")
if(KINECTLAB_WERROR)
  add_compile_options(-Werror)
endif()
if(KINECTLAB_SANITIZE)
  set(CMAKE_CXX_FLAGS_DEBUG "-O1 -g1")  # -O0 Eigen under a sanitizer takes minutes
  add_compile_options(-fsanitize=${KINECTLAB_SANITIZE} -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${KINECTLAB_SANITIZE})
endif()

find_program(CCACHE ccache)
if(CCACHE)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros ${CCACHE})
  add_compile_options(-fpch-preprocess)
endif()
find_program(MOLD mold)
if(MOLD)
  add_link_options(-fuse-ld=mold)
endif()
