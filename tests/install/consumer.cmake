# Installs Cattaneo, extracts the examples from README.md, docs/embedding.md and docs/exchange.md, builds
# them as projects of their own with find_package(Cattaneo), that of the core alone where there is
# no MFEM, and runs them. With EACH_HEADER every
# installed header is compiled alone, too.
set(prefix ${BINARY}/install-test/prefix)
set(project ${BINARY}/install-test/project)
file(REMOVE_RECURSE ${BINARY}/install-test)
file(MAKE_DIRECTORY ${project})

function(step)
   execute_process(COMMAND ${ARGN} RESULT_VARIABLE code OUTPUT_VARIABLE out ERROR_VARIABLE out)
   if(code)
      message(FATAL_ERROR "${ARGN}\nended with ${code}:\n${out}")
   endif()
   set(output "${out}" PARENT_SCOPE)
endfunction()

# The first C++ example of a page from a heading on as a program.
function(extract page heading program)
   file(READ ${SOURCE}/${page} text)
   string(FIND "${text}" "${heading}\n" begin)
   if(begin EQUAL -1)
      message(FATAL_ERROR "${page} has no line '${heading}'")
   endif()
   string(SUBSTRING "${text}" ${begin} -1 text)
   string(FIND "${text}" "```cpp\n" begin)
   if(begin EQUAL -1)
      message(FATAL_ERROR "${page} has no C++ example")
   endif()
   math(EXPR begin "${begin} + 7")
   string(SUBSTRING "${text}" ${begin} -1 text)
   string(FIND "${text}" "```" end)
   string(SUBSTRING "${text}" 0 ${end} example)
   file(WRITE ${program}.cpp "${example}")
endfunction()
extract(README.md "# Cattaneo" ${project}/embed)
extract(docs/embedding.md "# Contact in an MFEM program" ${project}/doors)
extract(docs/embedding.md "## Core alone" ${project}/core/bars)
extract(docs/exchange.md "## In a program" ${project}/core/laps)
# The march that is watched has no program around it on its page.
extract(docs/embedding.md "A long march can be watched, stopped and continued:" ${project}/watched)
file(READ ${project}/watched.cpp watched)
file(APPEND ${project}/doors.cpp "#include <atomic>
using namespace cattaneo;
void watch(Reduction &reduction, const ElasticBody &body, const LoadHistory &loads, ContactState &state)
{
const ReducedProblem &problem = reduction.problem;
${watched}}
")
file(COPY ${SOURCE}/tests/install/CMakeLists.txt ${SOURCE}/tests/install/core DESTINATION ${project})
if(EACH_HEADER)
   file(GLOB_RECURSE headers RELATIVE ${SOURCE}/plugin ${SOURCE}/plugin/cattaneo/*.hpp)
   foreach(header IN LISTS headers)
      string(MAKE_C_IDENTIFIER ${header} name)
      file(WRITE ${project}/alone/${name}.cpp "#include <${header}>\n")
   endforeach()
endif()

step(${CMAKE_COMMAND} --install ${BINARY} --prefix ${prefix})
# Without a build type it is compiled in half the time, with Eigen's assertions.
set(settings -G Ninja -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_PREFIX_PATH=${prefix})
set(without -DCMAKE_DISABLE_FIND_PACKAGE_MFEM=ON)
step(${CMAKE_COMMAND} -S ${project}/core -B ${project}/build/core ${settings} ${without})
step(${CMAKE_COMMAND} --build ${project}/build/core)
execute_process(COMMAND ${CMAKE_COMMAND} -S ${project} -B ${project}/refused ${settings} ${without}
   RESULT_VARIABLE code OUTPUT_QUIET ERROR_VARIABLE output)
if(NOT code OR NOT output MATCHES "COMPONENTS[ \n]+core")
   message(FATAL_ERROR "without MFEM the whole of Cattaneo must be refused, and what needs none named:\n${output}")
endif()
# The MFEM that was brought is installed too, a user's own is named.
set(bundled ${prefix}/lib/cattaneo/mfem)
if(NOT EXISTS ${bundled})
   list(APPEND settings -DMFEM_DIR=${MFEM_DIR})
endif()
step(${CMAKE_COMMAND} -S ${project} -B ${project}/build ${settings})
step(${CMAKE_COMMAND} --build ${project}/build)
# Whoever is given a header is told of it: the examples reach all that are installed by one of them.
step(${CMAKE_COMMAND} -E chdir ${project}/build ninja -t deps)
file(GLOB_RECURSE headers RELATIVE ${prefix}/include ${prefix}/include/cattaneo/*.hpp)
foreach(header IN LISTS headers)
   if(NOT output MATCHES "/${header}\n")
      message(FATAL_ERROR "${header} is installed, and <cattaneo/cattaneo.hpp> does not include it")
   endif()
endforeach()
file(COPY ${SOURCE}/meshes/calculix/ DESTINATION ${project}/build)
foreach(program IN ITEMS embed doors core/bars core/laps)
   step(${CMAKE_COMMAND} -E chdir ${project}/build ./${program})
   message("${program}: ${output}")
   if(NOT output MATCHES "converged")
      message(FATAL_ERROR "the example did not report a converged march")
   endif()
endforeach()
