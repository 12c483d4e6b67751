# The page that `GET /` and `steerstat report` show, built from TypeScript by npm. A program without it does all the
# rest and says what it lacks.
set(STEERSTAT_PAGE AUTO CACHE STRING
  "Build the page: ON, OFF, or AUTO: where Node 18 or later and npm are, and it builds")
set_property(CACHE STEERSTAT_PAGE PROPERTY STRINGS AUTO ON OFF)

# Whether npm and a Node that can build the page are here; if not, `reason` says what is missing.
function(steerstat_find_node found reason)
  find_program(STEERSTAT_NODE node)
  find_program(STEERSTAT_NPM npm)
  mark_as_advanced(STEERSTAT_NODE STEERSTAT_NPM)
  set(${found} FALSE PARENT_SCOPE)
  if(NOT STEERSTAT_NODE OR NOT STEERSTAT_NPM)
    set(${reason} "there was no npm where it was built" PARENT_SCOPE)
    return()
  endif()
  execute_process(COMMAND ${STEERSTAT_NODE} --version
    OUTPUT_VARIABLE version OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  string(REGEX REPLACE "^v" "" version "${version}")
  if(NOT version VERSION_GREATER_EQUAL 18)
    set(${reason} "Node was ${version} where it was built, and the page takes 18 or later" PARENT_SCOPE)
    return()
  endif()
  set(${found} TRUE PARENT_SCOPE)
endfunction()

# steerstat_build_page(SOURCE FILES_VARIABLE)
#
# Makes the target page_files, which leaves index.html, page.css, page.js and absence.txt in a folder: the page's files,
# or empty ones and in absence.txt why. Presets share the folder, so that they build the page once.
function(steerstat_build_page source files_variable)
  cmake_path(GET CMAKE_BINARY_DIR PARENT_PATH beside)
  if(beside STREQUAL "${CMAKE_SOURCE_DIR}/build" AND NOT STEERSTAT_PAGE STREQUAL "OFF")
    set(files ${beside}/page)
  else()
    set(files ${CMAKE_BINARY_DIR}/page)
  endif()
  set(${files_variable} ${files} PARENT_SCOPE)
  set(outputs ${files}/index.html ${files}/page.css ${files}/page.js ${files}/absence.txt)
  set(absence "")
  if(STEERSTAT_PAGE STREQUAL "OFF")
    set(absence "it was built with STEERSTAT_PAGE=OFF")
  else()
    steerstat_find_node(found absence)
    if(NOT found AND STEERSTAT_PAGE STREQUAL "ON")
      message(FATAL_ERROR "STEERSTAT_PAGE is ON, but ${absence}; install Node 18 or later with npm, or set it to AUTO")
    endif()
  endif()
  if(absence)
    message(STATUS "The page is not built: ${absence}")
    file(MAKE_DIRECTORY ${files})
    foreach(file index.html page.css page.js)
      file(CONFIGURE OUTPUT ${files}/${file} CONTENT "")
    endforeach()
    file(CONFIGURE OUTPUT ${files}/absence.txt CONTENT "${absence}")
    add_custom_target(page_files)
    return()
  endif()
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${source}/src/* ${CMAKE_SOURCE_DIR}/schemas/*.json
    ${CMAKE_SOURCE_DIR}/studies/specs/*.json)
  list(FILTER sources EXCLUDE REGEX "/src/generated/")
  file(GLOB settings CONFIGURE_DEPENDS ${source}/*.html ${source}/*.json ${source}/*.ts ${source}/*.mjs)
  add_custom_command(
    OUTPUT ${outputs}
    COMMAND ${CMAKE_COMMAND} -DNPM=${STEERSTAT_NPM} -DSOURCE=${source} -DFILES=${files} -DREQUIRED=${STEERSTAT_PAGE}
      -P ${CMAKE_SOURCE_DIR}/cmake/build_page.cmake
    DEPENDS ${sources} ${settings} ${CMAKE_SOURCE_DIR}/cmake/build_page.cmake
    COMMENT "Building the page with npm"
    VERBATIM)
  add_custom_target(page_files DEPENDS ${outputs})
endfunction()
