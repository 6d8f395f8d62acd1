// image_test.cpp
