# surfacediffusion_panel(<template> <output>): the server manager's XML of a filter, from a file of
# Plugin whose properties come from the declarations of the settings (GeneratePanels.cxx).
function (surfacediffusion_panel template output)
  if (NOT TARGET GeneratePanels)
    add_executable(GeneratePanels "${PROJECT_SOURCE_DIR}/Plugin/GeneratePanels.cxx")
    target_link_libraries(GeneratePanels PRIVATE SurfaceDiffusionCore)
    target_compile_options(GeneratePanels PRIVATE ${surfacediffusion_warnings} $<$<CONFIG:Release>:-O1>)
  endif ()
  add_custom_command(
    OUTPUT  "${output}"
    COMMAND GeneratePanels "${template}" "${output}"
    DEPENDS GeneratePanels "${template}"
    VERBATIM)
endfunction ()
