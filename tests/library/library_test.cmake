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
# The balls' angle and the sleeve's height of the paper's governor at 11 rad/s, to the digits that are printed.
if(failed OR NOT said MATCHES "Converged. stable" OR NOT said MATCHES "slide 0\\.150[0-9]+ \\+- [0-9.e-]+ m")
  message(FATAL_ERROR "the program that uses the library ended with ${failed}")
endif()
file(GLOB_RECURSE headers ${work}/prefix/*.hpp ${work}/prefix/*.cmake)
foreach(header ${headers})
  file(READ ${header} text)
  if(text MATCHES "${CMAKE_CURRENT_LIST_DIR}")
    message(FATAL_ERROR "${header} points into the source tree")
  endif()
endforeach()
