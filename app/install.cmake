# What is installed with the program (component `program`), in a tree that can be moved: the build tree has the
# same shape, so that files are found in one way only.
set(data ${CMAKE_BINARY_DIR}/share/flyball)
file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/share)
file(RELATIVE_PATH assets ${CMAKE_BINARY_DIR}/share ${PROJECT_SOURCE_DIR}/assets)
file(CREATE_LINK ${assets} ${data} SYMBOLIC)

# The manual and the completions are the program's own words.
set(words ${CMAKE_CURRENT_BINARY_DIR}/words)
add_custom_command(
  OUTPUT ${words}/done
  COMMAND ${CMAKE_COMMAND} -E rm -rf ${words}
  COMMAND flyball manual ${words}/man1
  COMMAND sh -c "gzip -9n ${words}/man1/*.1"
  COMMAND flyball completion bash > ${words}/bash
  COMMAND flyball completion zsh > ${words}/zsh
  COMMAND flyball completion fish > ${words}/fish
  COMMAND ${CMAKE_COMMAND} -E touch ${words}/done
  DEPENDS flyball
  COMMENT "Writing the manual and the shells' completions"
  VERBATIM)
add_custom_target(flyball_words ALL DEPENDS ${words}/done)

include(GNUInstallDirs)
install(TARGETS flyball DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
if(TARGET flyball_mpi) # by itself (component `mpi`): the package asks for no MPI
  install(TARGETS flyball_mpi LIBRARY DESTINATION ${mpi_folder} COMPONENT mpi)
endif()
install(DIRECTORY ${PROJECT_SOURCE_DIR}/assets/scenes DESTINATION share/flyball COMPONENT program)
install(FILES ${PROJECT_SOURCE_DIR}/assets/scene.schema.json DESTINATION share/flyball COMPONENT program)
install(DIRECTORY ${words}/man1 DESTINATION ${CMAKE_INSTALL_MANDIR} COMPONENT program)
install(FILES ${words}/bash DESTINATION share/bash-completion/completions RENAME flyball COMPONENT program)
install(FILES ${words}/zsh DESTINATION share/zsh/vendor-completions RENAME _flyball COMPONENT program)
install(FILES ${words}/fish DESTINATION share/fish/vendor_completions.d RENAME flyball.fish COMPONENT program)

# The desktop's: menu entry, icon, type of `*.flyball.json` and its thumbnails, software centre.
set(desktop ${PROJECT_SOURCE_DIR}/assets/desktop)
install(FILES ${desktop}/flyball.desktop DESTINATION share/applications COMPONENT program)
install(FILES ${desktop}/flyball.svg DESTINATION share/icons/hicolor/scalable/apps COMPONENT program)
install(FILES ${desktop}/flyball.svg DESTINATION share/icons/hicolor/scalable/mimetypes
  RENAME application-x-flyball+json.svg COMPONENT program)
install(FILES ${desktop}/flyball.xml DESTINATION share/mime/packages COMPONENT program)
install(FILES ${desktop}/flyball.thumbnailer DESTINATION share/thumbnailers COMPONENT program)
configure_file(${desktop}/flyball.metainfo.xml ${CMAKE_CURRENT_BINARY_DIR}/flyball.metainfo.xml @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/flyball.metainfo.xml DESTINATION share/metainfo COMPONENT program)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright COMPONENT program)

# Fonts by themselves (component `fonts`): a package depends on those of the distribution instead.
set(font_folders /usr/share/fonts/opentype/inter /usr/share/fonts/truetype/inter /usr/share/fonts/truetype/jetbrains-mono
  /usr/share/fonts/truetype/font-awesome /usr/share/fonts/truetype/dejavu)
foreach(name Inter-Regular Inter-SemiBold JetBrainsMono-Regular fontawesome-webfont DejaVuSans)
  find_file(FLYBALL_FONT_${name} NAMES ${name}.otf ${name}.ttf PATHS ${font_folders} NO_DEFAULT_PATH)
  if(FLYBALL_FONT_${name})
    install(FILES ${FLYBALL_FONT_${name}} DESTINATION share/flyball/fonts COMPONENT fonts)
  endif()
endforeach()

# Packages: `cpack` in the build folder.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME flyball)
set(CPACK_PACKAGE_CONTACT "Flyball authors <authors@flyball.invalid>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "steady states of mechanisms driven at constant speed")
set(CPACK_PACKAGE_DESCRIPTION "Builds mechanisms in an editor, drives some of their joints at constant
speed and shows at once where everything else settles: all equilibria,
their stability, branches over any number, and the damped motion beside.")
set(CPACK_COMPONENTS_ALL program)
set(CPACK_COMPONENTS_GROUPING ALL_COMPONENTS_IN_ONE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# OpenGL is loaded at run time: with a display by GLX, without one by OSMesa or EGL.
set(CPACK_DEBIAN_PACKAGE_DEPENDS
  "libgl1, libosmesa6 | libegl1, fonts-inter, fonts-jetbrains-mono, fonts-font-awesome, fonts-dejavu-core")
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "libgl1-mesa-dri, libegl-mesa0")
include(CPack)
