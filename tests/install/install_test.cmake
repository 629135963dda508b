# Install: what is installed is enough to build and run programs, with the library as a static and as a
# shared one.
#
# Needs BUILD (a built tree), KIND (static or shared), HELLO (the README's program), CXX, WORK (a folder
# to use up).
file(REMOVE_RECURSE ${WORK})

function(run)
  execute_process(COMMAND ${ARGN} OUTPUT_VARIABLE printed ERROR_VARIABLE printed
    RESULT_VARIABLE status)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${ARGN}: ${status}\n${printed}")
  endif()
  set(printed "${printed}" PARENT_SCOPE)
endfunction()

run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix --component headers)
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix --component ${KIND})
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix --component cooking)
run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR} -B ${WORK}/build -G Ninja
  -DCMAKE_CXX_COMPILER=${CXX} -DCMAKE_PREFIX_PATH=${WORK}/prefix -DHELLO=${HELLO})
run(${CMAKE_COMMAND} --build ${WORK}/build)

run(${WORK}/build/hello)
if(NOT printed MATCHES "rests at 9\\.[45][0-9] m")
  message(FATAL_ERROR "ten crates of 1 m stand on the ground, but: ${printed}")
endif()
run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR}/../../examples -B ${WORK}/examples -G Ninja
  -DCMAKE_CXX_COMPILER=${CXX} -DCMAKE_PREFIX_PATH=${WORK}/prefix)
run(${CMAKE_COMMAND} --build ${WORK}/examples)
run(${WORK}/examples/level)
file(MAKE_DIRECTORY ${WORK}/tour)
run(${WORK}/build/tour ${WORK}/tour)

run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
run(${WORK}/prefix/bin/throng --help)
file(REMOVE_RECURSE ${WORK})
