#!/bin/sh
# Fails when a kernel's object file defines a function that another source might define too: the linker may keep either,
# and a machine without the kernel's instruction set cannot run the kernel's. core/instruction_set.hpp has the rule.
#
#   check_kernel_symbols.sh OBJECT...
for object in "$@"; do
  case $object in *lockstep_*) ;; *) continue ;; esac
  set=$(basename "$object" | sed 's/^lockstep_\(.*\)\.cpp\.o$/\1/')
  case $set in avx512 | avx2 | portable) ;; *) continue ;; esac
  checked="$checked $set"
  # Weak functions are shared by name: only the kernel's own namespace may have any.
  shared=$(nm --demangle --defined-only "$object" | grep ' [Ww] ' | grep -v "steerstat::$set::")
  if [ -n "$shared" ]; then
    echo "$object shares functions with other sources:"
    echo "$shared"
    exit 1
  fi
  if ! nm --demangle --defined-only "$object" | grep -q "steerstat::$set::make_kernel"; then
    echo "$object: no kernel"
    exit 1
  fi
done
[ -n "$checked" ] || { echo "no kernel was checked"; exit 1; }
echo "checked:$checked"
