// lights_test.cpp
