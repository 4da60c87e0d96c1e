// A slider that moves by itself: that it is dragged is told by "drag", its place and whether it has been let go.
export default {
  template: `<q-slider :model-value="at" @update:model-value="move" @pan="hold" />`,
  props: { modelValue: Number },
  emits: ["drag"],
  data() {
    return { at: this.modelValue, held: false };
  },
  watch: {
    modelValue(at) {
      this.at = at;
    },
  },
  methods: {
    move(at) {
      this.at = at;
      this.$emit("drag", at, !this.held);
    },
    hold(phase) {
      this.held = phase === "start";
      if (!this.held) this.$emit("drag", this.at, true);
    },
  },
};
