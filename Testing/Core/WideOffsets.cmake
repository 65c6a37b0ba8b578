# Fails if a source in FOLDER adds a product to data() that is computed in 32 bits: the place of a
# row in an array of n x k numbers exceeds them although n does not.
cmake_minimum_required(VERSION 3.22)

file(GLOB_RECURSE sources "${FOLDER}/*.h" "${FOLDER}/*.cxx")
set(number_of_offsets 0)
foreach (source IN LISTS sources)
  file(STRINGS "${source}" lines REGEX "\\(\\) \\+ .*\\*")
  foreach (line IN LISTS lines)
    if (line MATCHES "data\\(\\) \\+ ")
      math(EXPR number_of_offsets "${number_of_offsets} + 1")
      if (NOT line MATCHES "data\\(\\) \\+ static_cast<std::(ptrdiff_t|size_t)>\\(")
        message(SEND_ERROR "${source}: \"${line}\"; allowed: data() + static_cast<std::ptrdiff_t>"
          "(row) * columns")
      endif ()
    endif ()
  endforeach ()
endforeach ()
if (number_of_offsets EQUAL 0)
  message(SEND_ERROR "no offset found in ${FOLDER}: the pattern is out of date")
endif ()
