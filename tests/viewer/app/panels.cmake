# What the panels say and draw, and what is written into files.
find_package(PNG REQUIRED)

pillarfield_test(viewer_export LINK viewer io SOURCES export_test.cpp made_field.cpp video_test.cpp)
target_link_libraries(viewer_export PRIVATE PNG::PNG)
pillarfield_test(viewer_plot LINK viewer SOURCES
  made_field.cpp pillar_panel_test.cpp plot_test.cpp region_plot_test.cpp value_words_test.cpp)

# Draws all panels into panels_*.png of the build tree.
pillarfield_device_test(viewer_panel_sheet LINK viewer SOURCES panel_sheet.cpp made_field.cpp)

foreach(program viewer_plot viewer_panel_sheet)
  target_include_directories(${program} SYSTEM PRIVATE ${PILLARFIELD_IMGUI_INCLUDE})
endforeach()
