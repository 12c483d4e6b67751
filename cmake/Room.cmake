# One library per engine folder, each with an include path of its own, so that including a folder one does not link does
# not compile.
#
#   steerstat_room(NAME [SOURCES file...] [USES room...] [LIBRARIES target...])
#
# SOURCES  .cpp files; none makes a header-only room
# USES     rooms whose headers it may include, passed on to those that use it
# LIBRARIES  third-party targets its sources need, not passed on
function(steerstat_room name)
  cmake_parse_arguments(ROOM "" "" "SOURCES;USES;LIBRARIES" ${ARGN})
  # "name/header.hpp" resolves through a link that holds this folder alone.
  set(path ${CMAKE_BINARY_DIR}/include/${name})
  file(MAKE_DIRECTORY ${path})
  file(CREATE_LINK ${CMAKE_CURRENT_SOURCE_DIR} ${path}/${name} SYMBOLIC)
  list(TRANSFORM ROOM_USES PREPEND steerstat::)
  if(ROOM_SOURCES)
    add_library(steerstat_${name} STATIC ${ROOM_SOURCES})
    target_include_directories(steerstat_${name} PUBLIC ${path})
    target_link_libraries(steerstat_${name} PUBLIC ${ROOM_USES} PRIVATE steerstat_flags ${ROOM_LIBRARIES})
  else()
    add_library(steerstat_${name} INTERFACE)
    target_include_directories(steerstat_${name} INTERFACE ${path})
    target_link_libraries(steerstat_${name} INTERFACE ${ROOM_USES})
  endif()
  add_library(steerstat::${name} ALIAS steerstat_${name})
endfunction()

# The tests of a room: an executable test_NAME of GoogleTest cases, each a CTest case.
#
#   steerstat_test(NAME SOURCES file... [USES room...] [LIBRARIES target...] [THREADED] [COST seconds]
#                  [RECORDS_ANSWERS])
#
# THREADED  starts threads, so that the thread sanitizer has something to find: labelled "threads" and built by the
#           target threaded_tests
# COST      what its longest cases take: CTest starts the longest first, so that none is left running alone at the end
# RECORDS_ANSWERS  what a service answers its clients is noted in STEERSTAT_ANSWERS (tests/server/recorder.hpp)
function(steerstat_test name)
  cmake_parse_arguments(TEST "THREADED;RECORDS_ANSWERS" "COST" "SOURCES;USES;LIBRARIES" ${ARGN})
  list(TRANSFORM TEST_USES PREPEND steerstat::)
  add_executable(test_${name} ${TEST_SOURCES})
  target_link_libraries(test_${name} PRIVATE ${TEST_USES} ${TEST_LIBRARIES} steerstat_flags GTest::gmock_main)
  target_compile_definitions(test_${name} PRIVATE STEERSTAT_SOURCE_DIR="${CMAKE_SOURCE_DIR}")
  # A test's own code runs for an instant; optimising it takes a fifth of its time to compile.
  target_compile_options(test_${name} PRIVATE $<$<CONFIG:Release>:-O1>)
  set(properties TIMEOUT 600)
  if(TEST_COST)
    list(APPEND properties COST ${TEST_COST})
  endif()
  if(TEST_THREADED)
    list(APPEND properties LABELS threads)
    add_dependencies(threaded_tests test_${name})
  endif()
  if(TEST_RECORDS_ANSWERS)
    list(APPEND properties FIXTURES_REQUIRED forgotten_answers FIXTURES_SETUP answers
      ENVIRONMENT STEERSTAT_ANSWERS=${STEERSTAT_ANSWERS})
  endif()
  gtest_discover_tests(test_${name} DISCOVERY_TIMEOUT 60 PROPERTIES ${properties})
endfunction()
