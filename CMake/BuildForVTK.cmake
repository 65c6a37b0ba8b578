# The parts that need VTK: the module with the filters, the Python module and ParaView's plugin.

# Dependencies. VTK's components are named because each one brings further packages in.
if (NOT SURFACEDIFFUSION_HOST STREQUAL "VTK")
  set(required)
  if (SURFACEDIFFUSION_HOST STREQUAL "ParaView")
    set(required REQUIRED)
  endif ()
  find_package(ParaView 5.11 QUIET ${required} COMPONENTS RemotingClientServerStream)
endif ()
set(vtk_module_components "CommonCore CommonDataModel CommonExecutionModel ParallelCore")
separate_arguments(vtk_components UNIX_COMMAND "${vtk_module_components}")
if (SURFACEDIFFUSION_WRAP_PYTHON)
  list(APPEND vtk_components Python WrappingPythonCore)
endif ()
set(vtk_test_components)
if (BUILD_TESTING)
  set(vtk_test_components FiltersCore FiltersSources IOImage ImagingCore RenderingCore
    RenderingFreeType RenderingOpenGL2)
endif ()
if (SURFACEDIFFUSION_BUILD_BENCHMARKS)
  list(APPEND vtk_test_components FiltersSources)
endif ()
find_package(VTK 9.1 REQUIRED COMPONENTS ${vtk_components} ${vtk_test_components}
  OPTIONAL_COMPONENTS ParallelMPI PythonInterpreter)
if (TARGET VTK::mpi AND NOT TARGET MPI::MPI_C)
  find_package(MPI REQUIRED COMPONENTS C) # VTK's targets name it without looking for it
endif ()

# PyPI's vtk for Linux has been compiled with the older of libstdc++'s two binary interfaces. A
# wheel takes the one that its VTK has.
if (SURFACEDIFFUSION_PYPI_VTK AND CMAKE_SYSTEM_NAME STREQUAL "Linux")
  if (NOT VTK_VERSION MATCHES "^${SURFACEDIFFUSION_PYPI_VTK}[.]")
    message(FATAL_ERROR "SURFACEDIFFUSION_PYPI_VTK is ${SURFACEDIFFUSION_PYPI_VTK}, but VTK "
      "${VTK_VERSION} was found in ${VTK_DIR}; install vtk-sdk ${SURFACEDIFFUSION_PYPI_VTK}")
  endif ()
  include(CheckCXXSourceCompiles)
  set(CMAKE_REQUIRED_LIBRARIES VTK::CommonCore)
  check_cxx_source_compiles([[
    #include <string>
    #include <vtkInformation.h>
    int main()
    {
      vtkInformationStringKey* key = nullptr;
      vtkInformation::New()->Set(key, std::string());
    }]] SURFACEDIFFUSION_VTK_HAS_DEFAULT_ABI)
  unset(CMAKE_REQUIRED_LIBRARIES)
  if (NOT SURFACEDIFFUSION_VTK_HAS_DEFAULT_ABI)
    add_compile_definitions(_GLIBCXX_USE_CXX11_ABI=0)
  endif ()
endif ()
add_subdirectory(Filters/Core) # with the same interface

include(CMakeDependentOption)
cmake_dependent_option(SURFACEDIFFUSION_BUILD_PLUGIN "Build the ParaView plugin" ON
  "ParaView_FOUND;NOT SKBUILD" OFF)
message(STATUS "SurfaceDiffusion: VTK ${VTK_VERSION}, "
  "ParaView ${ParaView_VERSION}, plugin ${SURFACEDIFFUSION_BUILD_PLUGIN}")
set(SURFACEDIFFUSION_PARAVIEW_VERSION "${ParaView_VERSION}" CACHE INTERNAL "For names of archives")

# Installation folder of the Python module
if (SURFACEDIFFUSION_WRAP_PYTHON)
  vtk_module_python_default_destination(python_destination)
endif ()
set(SURFACEDIFFUSION_PYTHON_DIR "${python_destination}" CACHE STRING
  "Where the Python module goes, relative to the prefix")
mark_as_advanced(SURFACEDIFFUSION_PYTHON_DIR)
set(python_destination "${SURFACEDIFFUSION_PYTHON_DIR}")
if (SKBUILD)
  set(python_destination ".")
endif ()

# The VTK module
vtk_module_scan(
  MODULE_FILES      "${PROJECT_SOURCE_DIR}/Filters/vtk.module"
  REQUEST_MODULES   SurfaceDiffusion::Filters
  PROVIDES_MODULES  modules
  REQUIRES_MODULES  required_modules
  ENABLE_TESTS      OFF)
vtk_module_build(
  MODULES             ${modules}
  PACKAGE             SurfaceDiffusion
  INSTALL_EXPORT      SurfaceDiffusion
  INSTALL_HEADERS     ${install_headers}
  LIBRARY_DESTINATION "${library_destination}"
  HEADERS_DESTINATION "${header_destination}"
  CMAKE_DESTINATION   "${cmake_destination}"
  LICENSE_DESTINATION "${license_destination}"
  ${library_version}
  ENABLE_WRAPPING     ON)

# The Python module
if (SURFACEDIFFUSION_WRAP_PYTHON)
  vtk_module_wrap_python(
    MODULES             ${modules}
    PYTHON_PACKAGE      vtkSurfaceDiffusion
    MODULE_DESTINATION  "${python_destination}"
    LIBRARY_DESTINATION "${library_destination}"
    CMAKE_DESTINATION   "${cmake_destination}"
    INSTALL_HEADERS     OFF
    BUILD_STATIC        OFF)
  # Where the classes of earlier sources are in this build folder; it would hide the package for numpy.
  file(REMOVE_RECURSE "${CMAKE_BINARY_DIR}/${python_destination}/surfacediffusion")
  set(python_dir "${CMAKE_BINARY_DIR}/${python_destination}/vtkSurfaceDiffusion")
  set(install_vtk "install VTK ${VTK_MAJOR_VERSION}.${VTK_MINOR_VERSION}") # what the error of another VTK says
  set(build_module "pip install Packaging/VTK")
  if (SURFACEDIFFUSION_PYPI_VTK)
    set(install_vtk "pip install vtk==${SURFACEDIFFUSION_PYPI_VTK}.*")
    set(build_module "Packaging/VTK/build_wheel.py")
  endif ()
  configure_file(CMake/__init__.py.in "${python_dir}/__init__.py" @ONLY)
  set(python_files "${python_dir}/__init__.py")

  # Types and documentation for editors, if this VTK has the generator. The generator loads the
  # module, which sanitizers do not allow.
  set(python ${Python3_EXECUTABLE})
  if (SKBUILD)
    list(APPEND python -I) # otherwise pip hides installed packages, among them VTK's
  endif ()
  execute_process(
    COMMAND ${python} -c "import vtkmodules.generate_pyi"
    RESULT_VARIABLE no_generator OUTPUT_QUIET ERROR_QUIET)
  if (NOT no_generator AND NOT CMAKE_CXX_FLAGS MATCHES "-fsanitize")
    set(stubs "${python_dir}/vtkSurfaceDiffusion.pyi")
    set(python_module vtkSurfaceDiffusionPython)
    if (TARGET PyvtkSurfaceDiffusionPython) # its name since VTK 9.7
      set(python_module PyvtkSurfaceDiffusionPython)
    endif ()
    add_custom_command(
      OUTPUT  "${stubs}"
      COMMAND ${python} "${PROJECT_SOURCE_DIR}/CMake/make_stubs.py"
              "${CMAKE_BINARY_DIR}/${python_destination}"
      DEPENDS ${python_module} "${PROJECT_SOURCE_DIR}/CMake/make_stubs.py"
      VERBATIM)
    add_custom_target(SurfaceDiffusionStubs ALL DEPENDS "${stubs}")
    file(TOUCH "${python_dir}/py.typed")
    list(APPEND python_files "${stubs}" "${python_dir}/py.typed")
  endif ()
  install(FILES ${python_files}
    DESTINATION "${python_destination}/vtkSurfaceDiffusion" COMPONENT python)
endif ()

# The ParaView plugin, and the toolbar with the macros if Qt and VTK's Python interpreter are found
if (SURFACEDIFFUSION_BUILD_PLUGIN)
  set(plugin_files "${PROJECT_SOURCE_DIR}/Plugin/paraview.plugin")
  set(qt Qt5)
  if (DEFINED PARAVIEW_QT_MAJOR_VERSION) # since ParaView 5.12
    set(qt Qt${PARAVIEW_QT_MAJOR_VERSION})
  endif ()
  find_package(${qt} QUIET COMPONENTS Widgets)
  set(has_toolbar OFF)
  if (TARGET ${qt}::Widgets AND TARGET VTK::PythonInterpreter)
    set(has_toolbar ON)
    list(APPEND plugin_files "${PROJECT_SOURCE_DIR}/Plugin/Toolbar/paraview.plugin")
  endif ()
  paraview_plugin_scan(
    PLUGIN_FILES      ${plugin_files}
    PROVIDES_PLUGINS  plugins
    REQUIRES_MODULES  required_modules
    ENABLE_BY_DEFAULT ON)
  set(no_plugin_documentation ON)
  if (SURFACEDIFFUSION_PLUGIN_DOCUMENTATION)
    set(no_plugin_documentation OFF)
  endif ()
  paraview_plugin_build(
    PLUGINS                   ${plugins}
    LIBRARY_DESTINATION       "${library_destination}"
    LIBRARY_SUBDIRECTORY      "${PARAVIEW_PLUGIN_SUBDIR}"
    PLUGINS_FILE_NAME         surfacediffusion.plugins.xml
    DISABLE_XML_DOCUMENTATION ${no_plugin_documentation})
endif ()
