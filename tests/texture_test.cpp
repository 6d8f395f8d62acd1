// texture_test.cpp
