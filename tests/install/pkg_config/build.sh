#!/bin/sh -e
: "${CXX:=c++}"
$CXX -std=c++20 -O2 robot.cpp -o robot $(pkg-config --static --cflags --libs accrete)
$CXX -std=c++20 -O2 scene.cpp -o scene $(pkg-config --static --cflags --libs accrete-hal)
