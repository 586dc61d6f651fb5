# Code generated at build time from idl/: never checked in.

find_program(FASTDDSGEN_PATH NAMES fastddsgen REQUIRED)

# What others' generators write is not what our sanitizer build is to examine: it is built as their
# libraries are, without.
set(pursuit_generated_options -g0)
if(PURSUIT_SANITIZE MATCHES "address")
    list(APPEND pursuit_generated_options -O0 -fno-sanitize=all)
endif()

# pursuit_idl_library(NAME IDL a.idl b.idl …): compiles IDL files by fastddsgen into one library.
# Included files are no dependency that fastddsgen reports, so each file depends on all of them;
# every output is declared, because some of its failures exit with 0.
function(pursuit_idl_library name)
    cmake_parse_arguments(arg "" "" "IDL" ${ARGN})
    set(out ${CMAKE_CURRENT_BINARY_DIR}/fastdds)
    file(MAKE_DIRECTORY ${out})
    set(inputs "")
    foreach(idl ${arg_IDL})
        list(APPEND inputs ${CMAKE_CURRENT_SOURCE_DIR}/${idl})
    endforeach()
    set(sources "")
    foreach(idl ${arg_IDL})
        get_filename_component(stem ${idl} NAME_WE)
        list(APPEND sources ${out}/${stem}.cxx ${out}/${stem}PubSubTypes.cxx)
        list(APPEND headers ${out}/${stem}.h ${out}/${stem}PubSubTypes.h)
    endforeach()
    # One call for all files: each start of the generator costs a second of Java.
    add_custom_command(
        OUTPUT ${sources} ${headers}
        COMMAND ${FASTDDSGEN_PATH} -cs -replace -I ${CMAKE_CURRENT_SOURCE_DIR} -d ${out} -t ${out}
                ${inputs}
        DEPENDS ${inputs}
        COMMENT "fastddsgen ${arg_IDL}"
        VERBATIM)
    add_library(${name} STATIC ${sources})
    target_include_directories(${name} SYSTEM PUBLIC ${out})
    target_link_libraries(${name} PUBLIC pursuit_options fastcdr fastrtps)
    target_compile_options(${name} PRIVATE ${pursuit_generated_options})
    pursuit_unity(${name} "${sources}" "")
endfunction()

# pursuit_proto_library(NAME PROTO a.proto …): compiles the on-disk schemas.
function(pursuit_proto_library name)
    cmake_parse_arguments(arg "" "" "PROTO" ${ARGN})
    set(out ${CMAKE_CURRENT_BINARY_DIR}/proto)
    file(MAKE_DIRECTORY ${out})
    add_library(${name} STATIC ${arg_PROTO})
    protobuf_generate(TARGET ${name} PROTOC_OUT_DIR ${out}
                      IMPORT_DIRS ${CMAKE_CURRENT_SOURCE_DIR} ${Protobuf_INCLUDE_DIRS})
    target_include_directories(${name} SYSTEM PUBLIC ${out})
    target_link_libraries(${name} PUBLIC pursuit_options protobuf::libprotobuf)
    target_compile_options(${name} PRIVATE ${pursuit_generated_options} $<$<CONFIG:Release>:-O1>)
endfunction()
