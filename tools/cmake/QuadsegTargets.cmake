# One place for the compiler settings of every target of the project; nothing is set globally, so parents stay unpolluted.
add_library(quadseg_settings INTERFACE)
target_compile_features(quadseg_settings INTERFACE cxx_std_20)
target_compile_options(quadseg_settings INTERFACE
    -Wall -Wextra -Wconversion -Wshadow -fno-math-errno -ffp-contract=off)
if(QUADSEG_ARCH AND NOT QUADSEG_ARCH STREQUAL "portable")
    target_compile_options(quadseg_settings INTERFACE -march=${QUADSEG_ARCH})
endif()
if(CMAKE_BUILD_TYPE STREQUAL "Release")
    target_compile_options(quadseg_settings INTERFACE -O3)
endif()
if(QUADSEG_SANITIZE)
    target_compile_options(quadseg_settings INTERFACE -fsanitize=${QUADSEG_SANITIZE} -fno-omit-frame-pointer
        -fno-sanitize-recover=all)
    target_link_options(quadseg_settings INTERFACE -fsanitize=${QUADSEG_SANITIZE})
endif()
if(QUADSEG_BUILD_FUZZERS)
    target_compile_options(quadseg_settings INTERFACE -fsanitize=fuzzer-no-link)
endif()
target_include_directories(quadseg_settings INTERFACE
    ${CMAKE_CURRENT_SOURCE_DIR}/engine/include ${CMAKE_CURRENT_SOURCE_DIR}/engine ${CMAKE_CURRENT_SOURCE_DIR})

# quadseg_room(NAME FOLDER [LINK libs...]): a room is its folder: every .cpp below it, an object library quadseg_room_NAME.
function(quadseg_room name folder)
    cmake_parse_arguments(ARG "" "" "LINK" ${ARGN})
    file(GLOB sources CONFIGURE_DEPENDS ${folder}/*.cpp)
    if(NOT sources)
        file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/${name}_empty.cpp "// the room ${name} has no source yet\n")
        set(sources ${CMAKE_CURRENT_BINARY_DIR}/${name}_empty.cpp)
    endif()
    add_library(quadseg_room_${name} OBJECT ${sources})
    set_target_properties(quadseg_room_${name} PROPERTIES POSITION_INDEPENDENT_CODE ON)
    # Public headers mark what is shown (export.h).
    set_target_properties(quadseg_room_${name} PROPERTIES CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
    target_link_libraries(quadseg_room_${name} PRIVATE quadseg_settings ${ARG_LINK})
endfunction()

# A shared library or module made of rooms shows quadseg's marked names only.
function(quadseg_hide_foreign_symbols target)
    if(CMAKE_SYSTEM_NAME STREQUAL "Linux" AND NOT QUADSEG_SANITIZE)
        set(map ${PROJECT_SOURCE_DIR}/tools/cmake/public_symbols.map)
        target_link_options(${target} PRIVATE -Wl,--version-script=${map})
        set_target_properties(${target} PROPERTIES LINK_DEPENDS ${map})
    endif()
endfunction()
