# Compiler flags of every target of ours.
add_library(steerstat_flags INTERFACE)
target_compile_features(steerstat_flags INTERFACE cxx_std_20)
target_compile_options(steerstat_flags INTERFACE
  -Wall -Wextra -Wpedantic -Wconversion -Wsign-conversion -Wshadow -Wnon-virtual-dtor -Wold-style-cast
  -Woverloaded-virtual -Wnull-dereference -Wdouble-promotion -Wformat=2 -Wimplicit-fallthrough -Wcast-align -Wundef
  # The same bits from every compiler and instruction set: a product and a sum fuse only where the source says fma.
  -ffp-contract=off
  # sqrt is one instruction where nobody asks for errno.
  -fno-math-errno)
if(STEERSTAT_WERROR)
  target_compile_options(steerstat_flags INTERFACE -Werror)
endif()
if(STEERSTAT_SANITIZE)
  target_compile_options(steerstat_flags INTERFACE
    -fsanitize=${STEERSTAT_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(steerstat_flags INTERFACE -fsanitize=${STEERSTAT_SANITIZE})
endif()
