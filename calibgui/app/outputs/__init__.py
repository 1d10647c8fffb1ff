"""Files that are written for others: folders of images, figures, boards to print."""
