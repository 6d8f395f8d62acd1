// scene.cpp
