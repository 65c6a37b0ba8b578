# Read by ctest for a GoogleTest program: one entry for each test, which runs it with all values of its
# parameter. gtest_discover_tests() makes an entry for each value, which is twice as many processes, whose
# starts take longer than most of these tests. An entry is skipped if all its values are, and failed if
# one is. surfacediffusion_test_executable() sets the variables program, folder, properties and drawing.
cmake_minimum_required(VERSION 3.22)
if (NOT EXISTS "${program}")
  cmake_path(GET program FILENAME name)
  add_test("${name}_NOT_BUILT" "${name}_NOT_BUILT")
  return ()
endif ()
execute_process(
  COMMAND "${program}" --gtest_list_tests
  WORKING_DIRECTORY "${folder}"
  TIMEOUT 60
  OUTPUT_VARIABLE lines
  RESULT_VARIABLE failed)
if (failed)
  message(FATAL_ERROR "${program} --gtest_list_tests: ${failed}\n${lines}")
endif ()
string(REGEX REPLACE "#[^\n]*|;" "" lines "${lines}") # the values behind the names
string(REPLACE "\n" ";" lines "${lines}")
set(names)
foreach (line IN LISTS lines)
  if (line MATCHES "^([^ ]+\\.) *$")
    set(suite "${CMAKE_MATCH_1}")
  elseif (line MATCHES "^  ([^ /]+)")
    list(APPEND names "${suite}${CMAKE_MATCH_1}")
  endif ()
endforeach ()
list(REMOVE_DUPLICATES names)
foreach (name IN LISTS names)
  add_test("${name}" "${program}" "--gtest_filter=${name}:${name}/*")
  set_tests_properties("${name}" PROPERTIES
    WORKING_DIRECTORY "${folder}"
    SKIP_REGULAR_EXPRESSION "\\[  PASSED  \\] 0 tests\\.\n(\\[  SKIPPED \\][^\n]*\n)+$"
    ${properties})
  if (NOT name MATCHES "${drawing}")
    set_tests_properties("${name}" PROPERTIES ENVIRONMENT_MODIFICATION "DISPLAY=unset:")
  endif ()
endforeach ()
