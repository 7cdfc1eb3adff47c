# Installs the library of the build folder BUILD, builds the program beside this file against it alone, and runs
# it: cmake -DBUILD=... -DSCENE=... -DGENERATOR=... -DCOMPILER=... -P library_test.cmake
set(work ${BUILD}/library_test)
file(REMOVE_RECURSE ${work})
foreach(step
    "--install|${BUILD}|--prefix|${work}/prefix|--component|library"
    "-S|${CMAKE_CURRENT_LIST_DIR}|-B|${work}/build|-G|${GENERATOR}|-DCMAKE_CXX_COMPILER=${COMPILER}|-DCMAKE_PREFIX_PATH=${work}/prefix|-DCMAKE_BUILD_TYPE=Release"
    "--build|${work}/build")
  string(REPLACE "|" ";" arguments "${step}")
  execute_process(COMMAND ${CMAKE_COMMAND} ${arguments} OUTPUT_VARIABLE said ERROR_VARIABLE said RESULT_VARIABLE failed)
  if(failed)
    message(FATAL_ERROR "cmake ${step}: ${said}")
  endif()
endforeach()
execute_process(COMMAND ${work}/build/uses_flyball ${SCENE} joints.spin.drive.speed OUTPUT_VARIABLE said RESULT_VARIABLE failed)
message("${said}")
# The collar of the paper's governor at 11.0174 rad/s stands at 0.15001745812529... m.
if(failed OR NOT said MATCHES "Converged. stable" OR NOT said MATCHES "slide 0\\.15001745812529[0-9]* \\+- [0-9.e-]+ m")
  message(FATAL_ERROR "the program that uses the library ended with ${failed}")
endif()
cmake_path(GET CMAKE_CURRENT_LIST_DIR PARENT_PATH tests)
cmake_path(GET tests PARENT_PATH source)
file(GLOB_RECURSE installed ${work}/prefix/*.hpp ${work}/prefix/*.cmake)
foreach(file ${installed})
  file(READ ${file} text)
  string(FIND "${text}" "${source}/" into_source)
  string(FIND "${text}" "${BUILD}/" into_build)
  if(NOT into_source EQUAL -1 OR NOT into_build EQUAL -1)
    message(FATAL_ERROR "${file} points into the source tree or the build folder")
  endif()
endforeach()
