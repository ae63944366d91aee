# SPDX-License-Identifier: Apache-2.0
# An Intel NUC of the last ten years: AVX2, BMI and FMA instructions. Contraction stays off. If results keep their bits has
# not been measured.
# CMAKE_SYSTEM_NAME is left alone, because setting it would make CMake treat this as cross-compiling.
set(CMAKE_C_FLAGS_INIT -march=x86-64-v3)
set(CMAKE_CXX_FLAGS_INIT -march=x86-64-v3)
