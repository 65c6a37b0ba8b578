# If the system has no Eigen, the build of a wheel takes that of the package cmeel-eigen from PyPI,
# which pip has put into the build environment.
find_package(Eigen3 3.3 QUIET NO_MODULE)
if (Eigen3_FOUND)
  return ()
endif ()
find_package(Python REQUIRED COMPONENTS Interpreter)
execute_process(
  COMMAND "${Python_EXECUTABLE}" -c "
import importlib.metadata
files = importlib.metadata.files('cmeel-eigen')
print(next(f for f in files if f.name == 'Eigen3Config.cmake').locate().parent.as_posix())"
  OUTPUT_VARIABLE Eigen3_DIR OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
set(Eigen3_DIR "${Eigen3_DIR}" CACHE PATH "Folder of Eigen3Config.cmake" FORCE)
