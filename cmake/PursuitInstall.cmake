# What `cmake --install` puts where the units in deploy/systemd look for it (docs/install.md).
include(GNUInstallDirs)

install(TARGETS pursuit-sensor pursuit-tracker pursuit-recorder pursuitctl
        RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(FILES deploy/systemd/pursuit-sensor.service deploy/systemd/pursuit-tracker.service
              deploy/systemd/pursuit-recorder.service
        DESTINATION lib/systemd/system)
install(FILES deploy/systemd/pursuit.sysusers DESTINATION lib/sysusers.d RENAME pursuit.conf)

set(doc ${CMAKE_INSTALL_DATAROOTDIR}/doc/pursuit)
install(FILES README.md LICENSE DESTINATION ${doc})
install(DIRECTORY docs idl DESTINATION ${doc}
        FILES_MATCHING PATTERN "*.md" PATTERN "*.png" PATTERN "*.idl" PATTERN "*.proto")
install(DIRECTORY deploy/config DESTINATION ${doc}/deploy)

# The configuration is the host's: one that is there is never written over.
install(CODE "set(samples ${CMAKE_SOURCE_DIR}/deploy/config)")
install(CODE [[
    foreach(name sensor tracker recorder)
        set(file $ENV{DESTDIR}/etc/pursuit/${name}.textproto)
        if(EXISTS ${file})
            message(STATUS "Left as it is: ${file}")
        else()
            file(INSTALL ${samples}/${name}.textproto DESTINATION /etc/pursuit)
        endif()
    endforeach()
]])
