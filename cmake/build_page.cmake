# Builds the page, run by the target page_files.
#
#   cmake -DNPM=npm -DSOURCE=server/dashboard -DFILES=DIRECTORY -DREQUIRED=ON|AUTO -P build_page.cmake
#
# Leaves index.html, page.css, page.js and an empty absence.txt in FILES. Where npm fails, as it does offline, it is an
# error with REQUIRED=ON; else the files are empty and absence.txt says why.
file(MAKE_DIRECTORY ${FILES})
file(LOCK ${FILES} DIRECTORY GUARD PROCESS TIMEOUT 600)  # builds of two presets share the folders
set(log ${FILES}/npm.log)

function(npm what)
  execute_process(COMMAND ${NPM} ${ARGN} WORKING_DIRECTORY ${SOURCE} OUTPUT_FILE ${log} ERROR_FILE ${log}
    RESULT_VARIABLE result)
  if(result EQUAL 0)
    return()
  endif()
  file(READ ${log} output)
  if(REQUIRED STREQUAL "ON")
    message(FATAL_ERROR "${what} failed:\n${output}")
  endif()
  message(WARNING "The program is built without the page, for ${what} failed:\n${output}")
  file(REMOVE ${FILES}/contents.txt)
  foreach(file index.html page.css page.js)
    file(WRITE ${FILES}/${file} "")
  endforeach()
  file(WRITE ${FILES}/absence.txt "${what} failed where it was built")
  set(failed TRUE PARENT_SCOPE)
endfunction()

# What the page is made of; another preset may have built it already.
cmake_path(GET SOURCE PARENT_PATH root)
cmake_path(GET root PARENT_PATH root)
file(GLOB_RECURSE sources ${SOURCE}/src/* ${root}/schemas/*.json ${root}/studies/specs/*.json)
list(FILTER sources EXCLUDE REGEX "/src/generated/")
file(GLOB settings ${SOURCE}/*.html ${SOURCE}/*.json ${SOURCE}/*.ts ${SOURCE}/*.mjs)
set(contents "")
foreach(file IN LISTS sources settings)
  file(SHA256 ${file} hash)
  string(APPEND contents "${file} ${hash}\n")
endforeach()
if(EXISTS ${FILES}/contents.txt AND EXISTS ${FILES}/page.js)
  file(READ ${FILES}/contents.txt built)
  if(built STREQUAL contents)
    file(TOUCH ${FILES}/index.html ${FILES}/page.css ${FILES}/page.js ${FILES}/absence.txt)
    return()
  endif()
endif()

set(failed FALSE)
# Packages are installed anew when the list of them changed.
set(installed ${SOURCE}/node_modules/.package-lock.json)
if(NOT EXISTS ${installed} OR ${SOURCE}/package-lock.json IS_NEWER_THAN ${installed})
  npm("installing the page's packages (npm ci)" ci --ignore-scripts --no-audit --no-fund)
endif()
if(NOT failed)
  npm("building the page (npm run build)" run build -- --outDir ${FILES}/dist --emptyOutDir)
endif()
if(NOT failed)
  foreach(file index.html page.css page.js)
    if(NOT EXISTS ${FILES}/dist/${file})
      message(FATAL_ERROR "the page's build left no ${file} in ${FILES}/dist "
        "(server/dashboard/README.md names its files)")
    endif()
    file(COPY_FILE ${FILES}/dist/${file} ${FILES}/${file})
  endforeach()
  file(WRITE ${FILES}/absence.txt "")
  file(WRITE ${FILES}/contents.txt "${contents}")
endif()
