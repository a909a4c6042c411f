# Ipopt::Ipopt (Debian: coinor-libipopt-dev). Headers are under coin/ up to 3.11 and under coin-or/
# from 3.14. Only the library itself is named: what pkg-config says drags a sequential MUMPS with a
# stub of MPI in front of the real one, and every rank of a parallel program then runs alone.
find_path(IPOPT_INCLUDE_DIR IpTNLP.hpp PATH_SUFFIXES coin-or coin)
find_library(IPOPT_LIBRARY ipopt)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Ipopt REQUIRED_VARS IPOPT_LIBRARY IPOPT_INCLUDE_DIR)
if(Ipopt_FOUND AND NOT TARGET Ipopt::Ipopt)
   add_library(Ipopt::Ipopt UNKNOWN IMPORTED)
   set_target_properties(Ipopt::Ipopt PROPERTIES
      IMPORTED_LOCATION "${IPOPT_LIBRARY}" INTERFACE_INCLUDE_DIRECTORIES "${IPOPT_INCLUDE_DIR}"
      # 3.11 looks for the standard headers only when told that they exist.
      INTERFACE_COMPILE_DEFINITIONS HAVE_CSTDDEF)
endif()
mark_as_advanced(IPOPT_INCLUDE_DIR IPOPT_LIBRARY)
